// Lokovic and Veach, Deep Shadow Maps, 2000: section 6, figure 6.
//
// The paper does not print the width of its filter. 16 samples leave nothing to gain in the map of 512 x 512, so the
// filter covers about 16 of its depths. The 400 samples are a random subset of the depths that it covers in the map of
// 4096 x 4096, so these are more than 400. Times of 19 s for 16 depths and 37 s for deep pixels fit about 16 pixels
// too. A filter 4 pixels of the smaller maps wide fulfils all three: 16 depths, 1,024 depths, 16 pixels.
//
// The printed deep map has 512 x 512 pixels of 256 samples, and as many depth samples as the map of 4096 x 4096. Both
// cannot be: they differ by a factor of 4. Claims are judged over three readings: as printed, with 64 samples a pixel,
// and with 256 x 256 pixels, as in figure 7.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "claims/lokovic.h"

namespace shadowbench::claims::lokovic {
namespace {

using results::Cell;
using results::LightResult;

struct ThreeMaps {
    results::Result small, large;
    results::Result printed, fewer_samples, fewer_pixels;  // the readings of the deep map
};

// A quantity for each reading of the deep map.
struct Readings {
    Value printed, fewer_samples, fewer_pixels;

    // The printed reading's value, and the interval that holds those of all three.
    Value all() const {
        return {printed.value, std::min({printed.low, fewer_samples.low, fewer_pixels.low}),
                std::max({printed.high, fewer_samples.high, fewer_pixels.high})};
    }
    std::string text() const {
        return fmt::format("{} as printed, {} with 64 samples a pixel, {} with 256 x 256 pixels", to_text(printed),
                           to_text(fewer_samples), to_text(fewer_pixels));
    }
    std::vector<Value> values() const { return {printed, fewer_samples, fewer_pixels}; }
};

const Cell& published(const results::Result& result) {
    return cell_of(light_of(result), "deep", {"compression=published", "kernel=box", "search=binary"});
}

template <class Of>
Readings readings(const ThreeMaps& maps, const Of& of) {
    return {of(published(maps.printed)), of(published(maps.fewer_samples)), of(published(maps.fewer_pixels))};
}

std::vector<std::string> settings(int resolution, int samples, int reference, const std::string& techniques) {
    return {fmt::format("rays.resolution={}", resolution),
            fmt::format("rays.samples_per_pixel={}", samples),
            fmt::format("reference.samples_per_pixel={}", reference),
            R"(receivers.footprint={"share":0.0078125})",  // 4 / 512
            "timing.repetitions=7",
            set_techniques(techniques)};
}

// A quick run has maps of the same sizes, since smaller ones would hold other hair in a pixel.
std::vector<std::string> smaller(int reference) {
    return {"reference.spread_seeds=0", fmt::format("reference.samples_per_pixel={}", reference)};
}

ThreeMaps run(const Context& context) {
    const std::string deep = published_deep();
    return {context.run(ball_scene, settings(512, 1, 64, placed_pcf(16, "jittered")), smaller(16)),
            context.run(ball_scene, settings(4096, 1, 4, placed_pcf(400, "jittered") + "," + placed_pcf(400, "subset")),
                        smaller(2)),
            context.run(ball_scene, settings(512, 256, 128, deep), smaller(16)),
            context.run(ball_scene, settings(512, 64, 128, deep), smaller(16)),
            context.run(ball_scene,
                        settings(256, 256, 512,
                                 deep + "," + published_deep("box", "cached") + "," + published_deep("pixels") + "," +
                                     published_deep("tent") + R"(,{"type":"deep"})"),
                        smaller(64))};
}

void add_table(const ThreeMaps& maps, PaperReport& report) {
    Table table{"Figure 6: hair and its shadow by three maps, over 4 / 512 of their width",
                {"map", "ns a lookup", "bytes", "error rms", "error max"},
                {}};
    const auto add = [&](const std::string& map, const Cell& cell) {
        table.rows.push_back({map, to_text(time_of(cell)), bytes_text(static_cast<double>(cell.bytes)),
                              to_text(error_of(cell)), fmt::format("{:.3g}", cell.lookup->norms.max)});
    };
    const auto add_depths = [&](const results::Result& result, const char* how, const char* placement) {
        const LightResult& light = light_of(result);
        add(fmt::format("depth map {}, {}", light.layout.width, how), cell_of(light, "pcf", {placement}));
    };
    const auto add_deep = [&](const results::Result& result, const char* how, const Cell& cell) {
        const results::MapDescription& layout = light_of(result).layout;
        add(fmt::format("deep map {}, {} samples a pixel, {}", layout.width, layout.samples(), how), cell);
    };
    const auto other = [&](const char* parameter) { return cell_of(light_of(maps.fewer_pixels), "deep", {parameter}); };
    constexpr const char* covered = "pixels weighted by their covered part";
    add_depths(maps.small, "16 jittered samples", "placement=jittered");
    add_depths(maps.large, "400 jittered samples", "placement=jittered");
    add_depths(maps.large, "a random subset of 400 depths", "placement=subset");
    add_deep(maps.printed, covered, published(maps.printed));
    add_deep(maps.fewer_samples, covered, published(maps.fewer_samples));
    add_deep(maps.fewer_pixels, covered, published(maps.fewer_pixels));
    add_deep(maps.fewer_pixels, "the same, from the segment that each pixel used last", other("search=cached"));
    add_deep(maps.fewer_pixels, "whole pixels inside the filter", other("kernel=pixels"));
    add_deep(maps.fewer_pixels, "a tent over whole pixels", other("kernel=tent"));
    add_deep(maps.fewer_pixels, "the program's defaults", other("compression=bounded"));
    report.tables.push_back(std::move(table));
}

void costs(const ThreeMaps& maps, const Cell& coarse, const Cell& fine, PaperReport& report) {
    const Readings faster = readings(maps, [&](const Cell& deep) { return time_of(fine) / time_of(deep); });
    report.claims.push_back(
        {"section 6, figure 6",
         "deep map lookups take 37 s where the 4096 map with 400 samples takes 559 s: 15 times faster",
         "4096 map over deep map, times: " + faster.text(), judge_gain(15.0, faster.all()),
         "Judged over the three readings of the deep map's size. A lookup searches 25 functions, or 9 of 256 x 256.",
         faster.values()});
    const Readings slower = readings(maps, [&](const Cell& deep) { return time_of(deep) / time_of(coarse); });
    report.claims.push_back(
        {"section 6, figure 6",
         "deep map lookups take 37 s where the 512 map with 16 samples takes 19 s: 1.9 times slower",
         "deep map over 512 map, times: " + slower.text(), judge_ratio(37.0 / 19.0, slower.all()),
         "Judged over the three readings. A search costs more than a depth test.", slower.values()});
    const Readings smaller = readings(maps, [&](const Cell& deep) { return bytes_of(fine) / bytes_of(deep); });
    report.claims.push_back(
        {"section 6, figure 6", "the deep map needs one sixth of the 4096 map's storage",
         "4096 map over deep map, bytes: " + smaller.text(), judge_gain(6.0, smaller.all()),
         "Judged over the three readings, bytes held. As printed the deep map has four times as many depth samples.",
         smaller.values()});
}

void qualities(const ThreeMaps& maps, const Cell& coarse, const Cell& fine, PaperReport& report) {
    const Value jittered = error_of(fine),
                subset = error_of(cell_of(light_of(maps.large), "pcf", {"placement=subset"}));
    report.claims.push_back({"section 6, figure 6",
                             "the 4096 map with 400 samples has much less noise than the 512 map with 16",
                             fmt::format("error rms {} against {}", to_text(jittered), to_text(error_of(coarse))),
                             judge_much_less(jittered, error_of(coarse)),
                             "The noise of the filter's samples and that of the map's own together.",
                             {jittered, error_of(coarse)}});
    const Readings stored = readings(maps, [](const Cell& deep) { return error_of(deep); });
    std::vector<Value> values = stored.values();
    values.insert(values.end(), {jittered, subset});
    report.claims.push_back(
        {"section 6, figure 6", "quality slightly better than the 4096 map, since every depth sample counts",
         fmt::format("error rms {}; 4096 map {} (400 jittered samples) and {} (a random subset of 400)", stored.text(),
                     to_text(jittered), to_text(subset)),
         in_all({judge_less(stored.all(), jittered), judge_less(stored.all(), subset)}),
         "Judged over the three readings, and against both ways to select samples: section 2 stratifies them.",
         std::move(values)});
}

}  // namespace

void three_maps(const Context& context) {
    const ThreeMaps maps = run(context);
    add_table(maps, *context.report);
    const Cell& coarse = cell_of(light_of(maps.small), "pcf");
    const Cell& fine = cell_of(light_of(maps.large), "pcf", {"placement=jittered"});
    costs(maps, coarse, fine, *context.report);
    qualities(maps, coarse, fine, *context.report);
}

}  // namespace shadowbench::claims::lokovic
