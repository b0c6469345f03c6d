// Plots by gnuplot, script and drawing in a temporary folder.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "base/error.h"
#include "base/read_text.h"
#include "base/temporary_folder.h"
#include "claims/report.h"

namespace shadowbench::claims {
namespace {

using base::Error;
using base::ErrorCode;

// In single quotes; `quote` stands for a quote within them.
std::string quoted(const std::string& text, const char* quote) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string(quote) : std::string(1, c);
    return out + "'";
}
std::string quoted(const std::string& text) {
    return quoted(text, "''");
}
std::string shell_quoted(const std::string& text) {
    return quoted(text, "'\\''");
}

std::string script_of(const Plot& plot, const std::filesystem::path& file) {
    std::string out = fmt::format(
        "set terminal svg size 720,440 dynamic noenhanced background 'white' font 'sans,13'\n"
        "set output {}\nset title {}\nset xlabel {}\nset ylabel {}\nset grid lc rgb '#dddddd'\nset key outside right\n"
        "set encoding utf8\n",
        quoted(file.string()), quoted(plot.title), quoted(plot.x_label), quoted(plot.y_label));
    if (plot.log_x) out += "set logscale x\n";
    if (plot.log_y) out += "set logscale y\n";
    for (std::size_t s = 0; s < plot.series.size(); ++s) {
        out += fmt::format("$s{} << EOD\n", s);
        for (const auto& [x, y] : plot.series[s].points) out += fmt::format("{:.9g} {:.9g}\n", x, y);
        out += "EOD\n";
    }
    out += "plot ";
    for (std::size_t s = 0; s < plot.series.size(); ++s)
        out +=
            fmt::format("{}$s{} using 1:2 with {} lw 2 pt 7 ps 0.5 title {}", s ? ", " : "", s,
                        plot.series[s].line ? (plot.series[s].points.size() > 40 ? "lines" : "linespoints") : "points",
                        quoted(plot.series[s].name));
    return out + "\n";
}

}  // namespace

std::string to_svg(const Plot& plot) {
    const base::TemporaryFolder folder;
    const std::filesystem::path svg = folder.path() / "plot.svg", script = folder.path() / "script";
    std::ofstream(script) << script_of(plot, svg);
    const int status = std::system(fmt::format("gnuplot {} > /dev/null 2>&1", shell_quoted(script.string())).c_str());
    if (status != 0 || !std::filesystem::exists(svg))
        throw Error(ErrorCode::internal, "gnuplot",
                    "could not draw " + plot.name + ": is gnuplot installed (Debian package gnuplot-nox)?");
    return base::read_text(svg);
}

}  // namespace shadowbench::claims
