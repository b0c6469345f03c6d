// Lokovic and Veach, Deep Shadow Maps, 2000: section 6, figure 9, and section 5.3.
#include <cmath>

#include <fmt/format.h>

#include "claims/lokovic.h"

namespace shadowbench::claims::lokovic {
using results::LightResult;

void filtering(const Context& context) {
    PaperReport& report = *context.report;
    const std::vector<int> widths{1, 2, 4, 8, 16, 32};
    const results::Result result = context.run(
        hair_ball,
        {"rays.samples_per_pixel=64", "reference.samples_per_pixel=64", "reference.queries=512",
         fmt::format(R"(sweeps={{"/receivers/filter_width":[{}]}})", fmt::join(widths, ",")),
         set_techniques(
             R"({"type":"deep","mip":"none","kernel":"tent"},{"type":"deep","mip":"nearest","kernel":"tent"},)" +
             pcf(64, "sample"))},
        {"rays.resolution=128"});
    Plot plot{"lokovic2000_figure9",
              "Lookup time over filter width",
              "filter width, share of the map",
              "ns a lookup",
              true,
              true,
              {}};
    const auto series = [&](const char* name, const char* technique, const std::vector<std::string>& parameters) {
        Series s{name, {}, true};
        for (const int width : widths) {
            const LightResult& light = light_of(result, {fmt::format("/receivers/filter_width={}", width)});
            s.points.emplace_back(static_cast<double>(width) / light.layout.width,
                                  time_of(cell_of(light, technique, parameters)).value);
        }
        plot.series.push_back(std::move(s));
    };
    series("depth map, 8 x 8 samples", "pcf", {});
    series("deep map", "deep", {"mip=none"});
    series("deep map with mip levels", "deep", {"mip=nearest"});
    report.plots.push_back(plot);

    const auto over = [&](const char* technique, const std::vector<std::string>& parameters, int from) {
        return time_of(cell_of(light_of(result, {"/receivers/filter_width=32"}), technique, parameters)) /
               time_of(
                   cell_of(light_of(result, {fmt::format("/receivers/filter_width={}", from)}), technique, parameters));
    };
    const Value depth = over("pcf", {}, 1), mip = over("deep", {"mip=nearest"}, 1),
                plain = over("deep", {"mip=none"}, 1);
    report.claims.push_back({"section 6, figure 9",
                             "depth map filtering time grows rapidly with width, at 8 x 8 samples",
                             fmt::format("width 32 takes {} times as long as width 1", to_text(depth)),
                             judge_growth(depth),
                             "The paper's growth is cache misses; here the whole map may stay in the cache.",
                             {depth}});
    report.claims.push_back({"section 6, figure 9",
                             "with mip levels deep filtering time is virtually constant in width",
                             fmt::format("width 32 takes {} times as long as width 1", to_text(mip)),
                             judge_constant(mip),
                             "Each lookup reads the same number of pixels of some level.",
                             {mip}});
    report.claims.push_back({"section 5.3",
                             "without mip levels the number of pixels read grows with the width",
                             fmt::format("width 32 takes {} times as long as width 1", to_text(plain)),
                             judge_exponent(2.0, {std::log(plain.value) / std::log(32.0),
                                                  std::log(plain.low) / std::log(32.0),
                                                  std::log(plain.high) / std::log(32.0)}),
                             "1,024 times the area covers about 1,024 times the functions; the exponent is that of the "
                             "time over the width.",
                             {plain}});
    const LightResult& light = light_of(result, {"/receivers/filter_width=1"});
    const Value size = exactly(static_cast<double>(cell_of(light, "deep", {"mip=nearest"}).bytes) /
                               static_cast<double>(cell_of(light, "deep", {"mip=none"}).bytes));
    report.claims.push_back({"section 5.3",
                             "all mip levels together are about 1.55 times as large as the base",
                             to_text(size) + " times",
                             judge_size(1.55, 4.0 / 3.0, size),
                             "The tolerance is halved from level to level, as the paper suggests.",
                             {size}});
}

}  // namespace shadowbench::claims::lokovic
