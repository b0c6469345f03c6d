// Lokovic and Veach, Deep Shadow Maps, 2000: section 6, figure 6.
//
// The paper does not print the width of its filter. 16 samples leave nothing to gain in the map of 512 x 512, so the
// filter covers about 16 of its depths. The 400 samples are a random subset of the depths that it covers in the map of
// 4096 x 4096, so these are more than 400. Times of 19 s for 16 depths and 37 s for deep pixels fit about 16 pixels
// too. A filter 4 pixels of the smaller maps wide fulfils all three: 16 depths, 1,024 depths, 16 pixels.
#include <fmt/format.h>

#include "claims/lokovic.h"

namespace shadowbench::claims::lokovic {
namespace {

using results::Cell;
using results::LightResult;

struct ThreeMaps {
    results::Result small, large, deep, fewer;
};

std::vector<std::string> settings(int resolution, int samples, int reference, const std::string& techniques) {
    return {fmt::format("rays.resolution={}", resolution),
            fmt::format("rays.samples_per_pixel={}", samples),
            fmt::format("reference.samples_per_pixel={}", reference),
            R"(receivers.footprint={"share":0.0078125})",  // 4 / 512
            "timing.repetitions=7",
            set_techniques(techniques)};
}

// Footprints of a quick run cover as many pixels.
std::vector<std::string> smaller(int resolution) {
    return {fmt::format("rays.resolution={}", resolution), R"(receivers.footprint={"share":0.03125})"};
}

ThreeMaps run(const Context& context) {
    const std::string deep = published_deep();
    return {context.run(ball_scene, settings(512, 1, 64, placed_pcf(16, "jittered")), smaller(128)),
            context.run(ball_scene, settings(4096, 1, 4, placed_pcf(400, "jittered") + "," + placed_pcf(400, "subset")),
                        smaller(1024)),
            context.run(
                ball_scene,
                settings(512, 256, 256,
                         deep + "," + published_deep("pixels") + "," + published_deep("tent") + R"(,{"type":"deep"})"),
                smaller(128)),
            context.run(ball_scene, settings(512, 64, 128, deep), smaller(128))};
}

void add_table(const ThreeMaps& maps, PaperReport& report) {
    Table table{"Figure 6: hair and its shadow by three maps, over 4 pixels of the smaller maps",
                {"map", "ns a lookup", "bytes", "error rms", "error max"},
                {}};
    const auto add = [&](const results::Result& result, const std::string& how, const char* technique,
                         const std::vector<std::string>& parameters) {
        const LightResult& light = light_of(result);
        const Cell& cell = cell_of(light, technique, parameters);
        const std::string map =
            technique == std::string("deep")
                ? fmt::format("deep map {}, {} samples a pixel", light.layout.width, light.layout.samples())
                : fmt::format("depth map {}", light.layout.width);
        table.rows.push_back({map + ", " + how, to_text(time_of(cell)), bytes_text(static_cast<double>(cell.bytes)),
                              to_text(error_of(cell)), fmt::format("{:.3g}", cell.lookup->norms.max)});
    };
    add(maps.small, "16 jittered samples", "pcf", {});
    add(maps.large, "400 jittered samples", "pcf", {"placement=jittered"});
    add(maps.large, "a random subset of 400 depths", "pcf", {"placement=subset"});
    add(maps.deep, "pixels weighted by their covered part", "deep", {"compression=published", "kernel=box"});
    add(maps.deep, "whole pixels inside the filter", "deep", {"kernel=pixels"});
    add(maps.deep, "a tent over whole pixels", "deep", {"kernel=tent"});
    add(maps.deep, "the program's defaults", "deep", {"compression=bounded"});
    add(maps.fewer, "pixels weighted by their covered part", "deep", {});
    report.tables.push_back(std::move(table));
}

void times(const Cell& coarse, const Cell& fine, const Cell& deep, PaperReport& report) {
    const Value faster = time_of(fine) / time_of(deep), slower = time_of(deep) / time_of(coarse);
    report.claims.push_back(
        {"section 6, figure 6",
         "deep map lookups take 37 s where the 4096 map with 400 samples takes 559 s: 15 times faster",
         to_text(faster) + " times faster",
         judge_gain(15.0, faster),
         "A footprint 4 pixels wide touches 25 functions, each of which is searched. A depth test needs no search.",
         {faster}});
    report.claims.push_back(
        {"section 6, figure 6",
         "deep map lookups take 37 s where the 512 map with 16 samples takes 19 s: 1.9 times slower",
         to_text(slower) + " times the time",
         judge_ratio(37.0 / 19.0, slower),
         "25 functions are searched where 16 depths are compared.",
         {slower}});
}

void qualities(const ThreeMaps& maps, const Cell& coarse, const Cell& deep, PaperReport& report) {
    const Value jittered = error_of(cell_of(light_of(maps.large), "pcf", {"placement=jittered"})),
                subset = error_of(cell_of(light_of(maps.large), "pcf", {"placement=subset"})), stored = error_of(deep);
    report.claims.push_back({"section 6, figure 6",
                             "the 4096 map with 400 samples has much less noise than the 512 map with 16",
                             fmt::format("error rms {} against {}", to_text(jittered), to_text(error_of(coarse))),
                             judge_much_less(jittered, error_of(coarse)),
                             "Noise of the filter and of the map's own samples together.",
                             {jittered, error_of(coarse)}});
    const Value fewer = error_of(cell_of(light_of(maps.fewer), "deep"));
    report.claims.push_back(
        {"section 6, figure 6",
         "quality slightly better than the 4096 map, since every depth sample counts",
         fmt::format("error rms {} against {} (400 jittered samples) and {} (a random subset of 400)", to_text(stored),
                     to_text(jittered), to_text(subset)),
         in_all({judge_less(stored, jittered), judge_less(stored, subset)}),
         fmt::format(
             "Judged against both ways to select samples: section 2 stratifies them. With as many depth samples "
             "as the 4096 map, 64 a pixel, the deep map has {}.",
             to_text(fewer)),
         {stored, jittered, subset, fewer}});
}

}  // namespace

void three_maps(const Context& context) {
    PaperReport& report = *context.report;
    const ThreeMaps maps = run(context);
    add_table(maps, report);
    const Cell& coarse = cell_of(light_of(maps.small), "pcf");
    const Cell& fine = cell_of(light_of(maps.large), "pcf", {"placement=jittered"});
    const Cell& deep = cell_of(light_of(maps.deep), "deep", {"compression=published", "kernel=box"});
    times(coarse, fine, deep, report);
    const Cell& fewer = cell_of(light_of(maps.fewer), "deep");
    const auto smaller_than = [&](const Cell& cell) {
        return exactly(static_cast<double>(fine.bytes) / static_cast<double>(cell.bytes));
    };
    report.claims.push_back(
        {"section 6, figure 6",
         "the deep map needs one sixth of the 4096 map's storage",
         fmt::format("1 / {}", to_text(smaller_than(deep))),
         judge_gain(6.0, smaller_than(deep)),
         fmt::format(
             "Both are bytes held. 256 samples a pixel, as printed, are four times as many as the 4096 map has; "
             "with as many, 64 a pixel, the share is 1 / {}.",
             to_text(smaller_than(fewer))),
         {smaller_than(deep), smaller_than(fewer)}});
    qualities(maps, coarse, deep, report);
}

}  // namespace shadowbench::claims::lokovic
