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

#include "base/parallel.h"
#include "claims/lokovic.h"
#include "claims/seeded_light.h"

namespace shadowbench::claims::lokovic {
namespace {

using results::Cell;
using results::LightResult;

// The scenarios of the maps, and what runs and turns of lookups make of them.
struct ThreeMaps {
    results::Result small, large;
    results::Result printed, fewer_samples, fewer_pixels;  // the readings of the deep map
    Turns ns;                                              // a lookup in each map
};
// The places of the maps among the turns: those of the scenarios, one after the other.
enum Place {
    coarse,
    coarse_64,
    fine,
    fine_subset,
    as_printed,
    with_64_samples,
    with_256_pixels,
    linear,
    cached,
    whole,
    tent_over,
    standard
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
    return {fmt::format("rays.resolution={}", resolution), fmt::format("rays.samples_per_pixel={}", samples),
            fmt::format("reference.samples_per_pixel={}", reference),
            R"(receivers.footprint={"share":0.0078125})",  // 4 / 512
            set_techniques(techniques)};
}

// The filter covers 4 x 4 cells of the smaller map. Percentage closer filtering takes one sample for each of so few,
// unless MinSamples asks for more.
constexpr const char* more_than_cells =
    R"({"type":"pcf","num_samples":64,"res_factor":1,"min_size":0,"min_samples":8})";

// A quick run has maps of the same sizes, since smaller ones would hold other hair in a pixel.
std::vector<std::string> smaller(int reference) {
    return {"reference.spread_seeds=0", fmt::format("reference.samples_per_pixel={}", reference)};
}

ThreeMaps run(const Context& context) {
    const std::string deep = published_deep();
    TimedMaps timed;
    const auto run_and_build = [&](int resolution, int samples, int reference, int quick_reference,
                                   const std::string& techniques) {
        const std::vector<std::string> set = settings(resolution, samples, reference, techniques);
        timed.add(context, ball_scene, set, smaller(quick_reference), 4096);
        return context.run(ball_scene, set, smaller(quick_reference));
    };
    ThreeMaps maps;
    maps.small = run_and_build(512, 1, 64, 16, placed_pcf(16, "jittered") + "," + more_than_cells);
    maps.large = run_and_build(4096, 1, 4, 2, placed_pcf(400, "jittered") + "," + placed_pcf(400, "subset"));
    maps.printed = run_and_build(512, 256, 128, 16, deep);
    maps.fewer_samples = run_and_build(512, 64, 128, 16, deep);
    maps.fewer_pixels =
        run_and_build(256, 256, 512, 64,
                      deep + "," + published_deep("box", "linear") + "," + published_deep("box", "cached") + "," +
                          published_deep("pixels") + "," + published_deep("tent") + R"(,{"type":"deep"})");
    std::vector<Compared> compared{{cached, linear}, {cached, with_256_pixels}};
    for (const Place deep_map : {as_printed, with_64_samples, with_256_pixels})
        compared.insert(compared.end(), {{fine, deep_map}, {deep_map, coarse}});
    maps.ns = timed.take(compared);
    return maps;
}

void add_table(const ThreeMaps& maps, PaperReport& report) {
    Table table{"Figure 6: hair and its shadow by three maps, over 4 / 512 of their width",
                {"map", "ns a lookup", "bytes", "error rms", "error max"},
                {}};
    const auto add = [&](Place place, const std::string& map, const Cell& cell) {
        table.rows.push_back({map, to_text(maps.ns.time(place)), bytes_text(static_cast<double>(cell.bytes)),
                              to_text(error_of(cell)), fmt::format("{:.3g}", cell.lookup->norms.max)});
    };
    const auto add_depths = [&](Place place, const results::Result& result, const char* how, const char* parameter) {
        const LightResult& light = light_of(result);
        add(place, fmt::format("depth map {}, {}", light.layout.width, how), cell_of(light, "pcf", {parameter}));
    };
    const auto add_deep = [&](Place place, const results::Result& result, const char* how, const Cell& cell) {
        const results::MapDescription& layout = light_of(result).layout;
        add(place, fmt::format("deep map {}, {} samples a pixel, {}", layout.width, layout.samples(), how), cell);
    };
    const auto add_other = [&](Place place, const char* how, const char* parameter) {
        add_deep(place, maps.fewer_pixels, how, cell_of(light_of(maps.fewer_pixels), "deep", {parameter}));
    };
    constexpr const char* covered = "pixels weighted by their covered part";
    add_depths(coarse, maps.small, "16 jittered samples", "num_samples=16");
    add_depths(coarse_64, maps.small, "64 jittered samples", "num_samples=64");
    add_depths(fine, maps.large, "400 jittered samples", "placement=jittered");
    add_depths(fine_subset, maps.large, "a random subset of 400 depths", "placement=subset");
    add_deep(as_printed, maps.printed, covered, published(maps.printed));
    add_deep(with_64_samples, maps.fewer_samples, covered, published(maps.fewer_samples));
    add_deep(with_256_pixels, maps.fewer_pixels, covered, published(maps.fewer_pixels));
    add_other(linear, "the same, from the first segment on", "search=linear");
    add_other(cached, "the same, from the segment that each pixel used last", "search=cached");
    add_other(whole, "whole pixels inside the filter", "kernel=pixels");
    add_other(tent_over, "a tent over whole pixels", "kernel=tent");
    add_other(standard, "the program's defaults", "compression=bounded");
    report.tables.push_back(std::move(table));
}

void costs(const ThreeMaps& maps, PaperReport& report) {
    const auto over = [&](Place one, Place other) { return maps.ns.ratio(one, other); };
    const Readings faster{over(fine, as_printed), over(fine, with_64_samples), over(fine, with_256_pixels)};
    report.claims.push_back(
        {"section 6, figure 6",
         "deep map lookups take 37 s where the 4096 map with 400 samples takes 559 s: 15 times faster",
         "4096 map over deep map, times: " + faster.text(), judge_gain(15.0, faster.all()),
         "Judged over the three readings of the deep map's size, at the paper's settings: errors are not equal, see "
         "the quality below. A lookup searches 25 functions, or 9 of 256 x 256.",
         faster.values()});
    const Readings slower{over(as_printed, coarse), over(with_64_samples, coarse), over(with_256_pixels, coarse)};
    report.claims.push_back(
        {"section 6, figure 6",
         "deep map lookups take 37 s where the 512 map with 16 samples takes 19 s: 1.9 times slower",
         "deep map over 512 map, times: " + slower.text(), judge_ratio(37.0 / 19.0, slower.all()),
         "Judged over the three readings, at the paper's settings: errors are not equal. A search costs more than a "
         "depth test.",
         slower.values()});
    const Value depths = bytes_of(cell_of(light_of(maps.large), "pcf", {"placement=jittered"}));
    const Readings share = readings(maps, [&](const Cell& deep) { return bytes_of(deep) / depths; });
    report.claims.push_back(
        {"section 6, figure 6", "the deep map needs one sixth of the 4096 map's storage",
         "deep map over 4096 map, bytes: " + share.text(), judge_size(1.0 / 6.0, 1.0, share.all()),
         "Judged over the three readings, bytes held. As printed the deep map has four times as many depth samples.",
         share.values()});
}

// Section 3.4, in the deep map of 256 x 256 pixels.
void searches(const ThreeMaps& maps, PaperReport& report) {
    const Value of_linear = maps.ns.ratio(cached, linear), of_binary = maps.ns.ratio(cached, with_256_pixels);
    report.claims.push_back(
        {"section 3.4",
         "a search from the segment that a pixel used last reduces the average cost of evaluating a function",
         fmt::format("{} times the time of a linear search from the first segment, {} times that of a binary search",
                     to_text(of_linear), to_text(of_binary)),
         both(judge_less(of_linear, exactly(1.0)), judge_less(of_binary, exactly(1.0))),
         "Against both searches that the paper names. Lookups in image order. The paper's pointer for each pixel is a "
         "table of the pixels used last here.",
         {of_linear, of_binary}});
}

void qualities(const ThreeMaps& maps, PaperReport& report) {
    const Value small = error_of(cell_of(light_of(maps.small), "pcf", {"num_samples=16"})),
                more = error_of(cell_of(light_of(maps.small), "pcf", {"num_samples=64"})),
                jittered = error_of(cell_of(light_of(maps.large), "pcf", {"placement=jittered"})),
                subset = error_of(cell_of(light_of(maps.large), "pcf", {"placement=subset"}));
    report.claims.push_back({"section 6, figure 6",
                             "the 4096 map with 400 samples has much less noise than the 512 map with 16",
                             fmt::format("error rms {} against {}", to_text(jittered), to_text(small)),
                             judge_much_less(jittered, small),
                             "The noise of the filter's samples and that of the map's own together.",
                             {jittered, small}});
    report.claims.push_back({"section 6, figure 6",
                             "more than 16 samples do not increase the quality of the 512 map's shadows",
                             fmt::format("error rms {} with 64 samples, {} with 16", to_text(more), to_text(small)),
                             judge_alike(more, small),
                             "The filter is as wide as 4 depths, and covers parts of up to 25.",
                             {more, small}});
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
    const base::ThreadLimit threads(context.threads);
    const ThreeMaps maps = run(context);
    add_table(maps, *context.report);
    costs(maps, *context.report);
    searches(maps, *context.report);
    qualities(maps, *context.report);
}

}  // namespace shadowbench::claims::lokovic
