// Lokovic and Veach, Deep Shadow Maps, 2000: section 6, figure 9.
#include "claims/lokovic_filtering.h"

#include <fmt/format.h>

#include "claims/lokovic.h"

namespace shadowbench::claims::lokovic {
namespace {

using results::Cell;
using results::LightResult;

constexpr int all_widths[] = {1, 2, 4, 8, 16, 32};  // pixels of a map of 256 x 256

std::string share_of(int width) {
    return fmt::format("{}", width / 256.0);
}

// The paper's deep map word for word, with these mip levels.
std::string deep_map(const char* mip) {
    return fmt::format(R"({{"type":"deep","compression":"published","search":"cached","mip":"{}"}})", mip);
}

results::Result measure_widths(const Context& context) {
    std::vector<std::string> shares;
    for (const int width : all_widths) shares.push_back(share_of(width));
    return context.run(ball_scene,
                       {"rays.samples_per_pixel=64", "reference.samples_per_pixel=16", "reference.queries=64",
                        "reference.spread_seeds=0",
                        fmt::format(R"(sweeps={{"/receivers/footprint/share":[{}]}})", fmt::join(shares, ",")),
                        set_techniques(deep_map("none") + "," + deep_map("nearest") + "," + pcf(64, "sample"))},
                       {"rays.resolution=128"});
}

struct Widths {
    results::Result result;

    const Cell& cell(int width, const char* technique, const std::vector<std::string>& parameters) const {
        return cell_of(light_of(result, {"/receivers/footprint/share=" + share_of(width)}), technique, parameters);
    }
    Value time(int width, const char* technique, const std::vector<std::string>& parameters = {}) const {
        return time_of(cell(width, technique, parameters));
    }
    // From the narrowest filter to the widest.
    Value growth(const char* technique, const std::vector<std::string>& parameters = {}) const {
        return time(32, technique, parameters) / time(1, technique, parameters);
    }
};

Plot plot_of(const Widths& widths) {
    Plot plot{"lokovic2000_figure9",
              "Lookup time over filter width",
              "filter width, share of the map",
              "ns a lookup",
              true,
              true,
              {}};
    const auto add = [&](const char* name, const char* technique, const std::vector<std::string>& parameters) {
        Series series{name, {}, true};
        for (const int width : all_widths)
            series.points.emplace_back(width / 256.0, widths.time(width, technique, parameters).value);
        plot.series.push_back(std::move(series));
    };
    add("depth map, 8 x 8 samples", "pcf", {});
    add("deep map", "deep", {"mip=none"});
    add("deep map with mip levels", "deep", {"mip=nearest"});
    return plot;
}

}  // namespace

void widths(const Context& context) {
    PaperReport& report = *context.report;
    const Widths widths{measure_widths(context)};
    report.plots.push_back(plot_of(widths));
    const Value depth = widths.growth("pcf"), mip = widths.growth("deep", {"mip=nearest"});
    const Value with = widths.time(32, "deep", {"mip=nearest"}), without = widths.time(32, "deep", {"mip=none"});
    report.claims.push_back({"section 6, figure 9",
                             "depth map filtering time grows rapidly with width, at 8 x 8 samples",
                             fmt::format("the widest filter takes {} times as long as the narrowest", to_text(depth)),
                             judge_growth(depth),
                             "The paper's growth is cache misses; here the whole map may stay in the cache.",
                             {depth}});
    report.claims.push_back({"section 6, figure 9",
                             "with mip levels deep filtering time is virtually constant in width",
                             fmt::format("the widest filter takes {} times as long as the narrowest", to_text(mip)),
                             judge_constant(mip),
                             "A lookup reads at most 4 x 4 pixels of one level. A filter as narrow as a pixel reads at "
                             "most 2 x 2.",
                             {mip}});
    report.claims.push_back(
        {"section 1",
         "mip-mapping can dramatically reduce lookup costs over a wide range of scales",
         fmt::format("at the widest filter, an eighth of the map, {} times the time of the same map "
                     "without levels",
                     to_text(with / without)),
         judge_much_less(with, without),
         "Without levels a lookup reads every pixel under the filter.",
         {with / without}});
}

void filtering(const Context& context) {
    widths(context);
    levels(context);
    blends(context);
    footprints(context);
    tiles(context);
}

}  // namespace shadowbench::claims::lokovic
