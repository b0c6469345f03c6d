#include <algorithm>
#include <ostream>

#include <fmt/format.h>

#include "base/error.h"
#include "base/table.h"
#include "scene/named_scenarios.h"
#include "service/cli/commands.h"
#include "service/cli/libraries.h"
#include "service/cli/scenario_files.h"
#include "service/cli/terminal.h"
#include "techniques/technique.h"
#include "techniques/trades.h"

namespace shadowbench::service {
namespace {

using techniques::Parameter;
using techniques::ParameterKind;

std::string values_of(const Parameter& parameter) {
    std::string text;
    if (parameter.kind != ParameterKind::choice) text = fmt::format("{:g} to {:g}", parameter.min, parameter.max);
    for (const char* word : parameter.words) text += (text.empty() ? "" : "|") + std::string(word);
    return text;
}

std::string standard_of(const Parameter& parameter) {
    return parameter.standard_word[0] != '\0' ? parameter.standard_word : fmt::format("{:g}", parameter.standard);
}

std::string promises_of(const techniques::Promises& promises) {
    std::string text;
    const auto add = [&](bool holds, const char* what) {
        if (holds) text += (text.empty() ? "" : ", ") + std::string(what);
    };
    add(promises.monotone, "never rises with depth");
    add(promises.unit_range, "stays in [0, 1]");
    add(promises.opaque_only, "for opaque scenes only");
    add(promises.early, "may be dark before the first surface");
    add(!promises.localised && !promises.approximate, "exact only before and behind all that casts shadows");
    if (promises.approximate)
        add(true, fmt::format("approximates, by up to {:.2g} behind all that casts shadows", promises.leak).c_str());
    else if (promises.leak > 0.0)
        add(true, fmt::format("leaves up to {:.2g} behind what is opaque", promises.leak).c_str());
    return text;
}

std::string trades_of(const techniques::Traits& traits) {
    std::string text = traits.traces ? "" : "resolution, samples_per_pixel";
    for (const techniques::Trade& trade : traits.trades)
        text += (text.empty() ? "" : ", ") + techniques::to_string(trade);
    return text;
}

// Labels with texts beside them. On a terminal, a text that is too long goes on below itself; elsewhere, each is a
// line.
class Listing {
public:
    Listing(std::ostream& out, std::size_t column)
        : out_(out), column_(column), width_(is_terminal(out) ? std::max(line_width(out), column + least_text) : 0) {}

    void add(const std::string& label, const std::string& text) const {
        if (width_ == 0 || label.size() >= column_) {
            out_ << fmt::format("{:<{}}{}\n", label, column_, text);
            return;
        }
        std::string lines = base::wrapped(std::string(column_, ' ') + text + "\n", width_);
        out_ << lines.replace(0, label.size(), label);
    }

private:
    static constexpr std::size_t least_text = 30;  // characters of a line

    std::ostream& out_;
    std::size_t column_, width_;
};

}  // namespace

void list_techniques(const LibraryArguments& libraries, std::ostream& out) {
    load_libraries(libraries);
    const Listing listing(out, 14);
    for (const techniques::Technique& row : techniques::all()) {
        listing.add(row.id, fmt::format("{} (version {}; {})", row.title, row.version, row.paper));
        if (!row.library.file.empty())
            listing.add("", fmt::format("external: {}, hash {}", row.library.file, row.library.hash));
        listing.add("", fmt::format("promises: {}", promises_of(row.promises)));
        for (const Parameter& parameter : row.parameters)
            listing.add("", fmt::format("{}={}  [{}] {}", parameter.name, standard_of(parameter), values_of(parameter),
                                        parameter.doc));
        listing.add("", fmt::format("recommend tries: {}", trades_of(row.traits)));
    }
}

void list_scenarios(std::ostream& out) {
    const std::vector<scene::NamedScenario> list = scene::list_scenarios(scenario_folders());
    if (list.empty())
        throw base::Error(
            base::ErrorCode::no_such_file, "scenarios",
            "./scenarios has none, and none was installed with the program; set SHADOWBENCH_SCENARIOS to folders "
            "that have some");
    std::size_t width = 0;
    for (const scene::NamedScenario& one : list) width = std::max(width, one.name.size() + 2);
    const Listing listing(out, width);
    for (const scene::NamedScenario& one : list) {
        listing.add(one.name, one.fault.empty() ? one.purpose : "cannot be read: " + one.fault);
        out << fmt::format("{:<{}}{}\n", "", width, one.file.string());  // whole, so that it can be copied
    }
}

}  // namespace shadowbench::service
