// Lokovic and Veach, Deep Shadow Maps, 2000: section 6, figure 6.
//
// The paper does not print the width of its filter. Ours is 4 pixels of the smaller maps wide: it covers 16 depths in
// the map of 512 x 512, as many as the paper's samples, and 1,024 in the map of 4096 x 4096, of which 400 are a subset.
//
// The printed deep map has 512 x 512 pixels of 256 samples, and as many depth samples as the map of 4096 x 4096. Both
// cannot be: they differ by a factor of 4. Claims are judged over three readings: as printed, with 64 samples a pixel,
// and with 256 x 256 pixels, as in figure 7; and each of them with pixels weighted by the part that the filter covers,
// and by their centres (section 3.4), where a box takes whole pixels.
#include <string>
#include <utility>
#include <vector>

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
    printed_by_centres,
    with_64_samples,
    samples_by_centres,
    with_256_pixels,
    pixels_by_centres,
    tent_over,
    standard
};
constexpr Place deep_maps[] = {as_printed,         with_64_samples,    with_256_pixels,
                               printed_by_centres, samples_by_centres, pixels_by_centres};

// A quantity for the readings of the deep map in the order of deep_maps: three, or all six.
using Readings = std::vector<Value>;

std::string text_of(const Readings& of) {
    std::string text = fmt::format("{} as printed, {} with 64 samples a pixel, {} with 256 x 256 pixels",
                                   to_text(of[0]), to_text(of[1]), to_text(of[2]));
    if (of.size() > 3)
        text += fmt::format("; by pixel centres {}, {}, {}", to_text(of[3]), to_text(of[4]), to_text(of[5]));
    return text;
}

std::vector<Judged> each_judged(const Readings& of, Judged (*judge)(const Value&)) {
    std::vector<Judged> each;
    for (const Value& one : of) each.push_back(judge(one));
    return each;
}

// Of the times of the slower one over those of the other.
Judged much_longer(const Value& times) {
    return judge_much_less(exactly(1.0), times);
}

Readings joined(Readings first, const Readings& more) {
    first.insert(first.end(), more.begin(), more.end());
    return first;
}

const Cell& published(const results::Result& result, const char* kernel = "box") {
    return cell_of(light_of(result), "deep", {"compression=published", fmt::format("kernel={}", kernel)});
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
    const std::string deep = published_deep() + "," + published_deep("pixels");
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
    maps.fewer_pixels = run_and_build(256, 256, 512, 64, deep + "," + published_deep("tent") + R"(,{"type":"deep"})");
    std::vector<Compared> compared{{fine, coarse}};
    for (const Place deep_map : deep_maps) compared.insert(compared.end(), {{fine, deep_map}, {deep_map, coarse}});
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
    constexpr const char *covered = "pixels weighted by their covered part",
                         *centres = "whole pixels whose centres lie inside the filter";
    add_depths(coarse, maps.small, "16 jittered samples", "num_samples=16");
    add_depths(coarse_64, maps.small, "64 jittered samples", "num_samples=64");
    add_depths(fine, maps.large, "400 jittered samples", "placement=jittered");
    add_depths(fine_subset, maps.large, "a random subset of 400 depths", "placement=subset");
    add_deep(as_printed, maps.printed, covered, published(maps.printed));
    add_deep(printed_by_centres, maps.printed, centres, published(maps.printed, "pixels"));
    add_deep(with_64_samples, maps.fewer_samples, covered, published(maps.fewer_samples));
    add_deep(samples_by_centres, maps.fewer_samples, centres, published(maps.fewer_samples, "pixels"));
    add_deep(with_256_pixels, maps.fewer_pixels, covered, published(maps.fewer_pixels));
    add_deep(pixels_by_centres, maps.fewer_pixels, centres, published(maps.fewer_pixels, "pixels"));
    add_other(tent_over, "a tent over whole pixels", "kernel=tent");
    add_other(standard, "the program's defaults", "compression=bounded");
    report.tables.push_back(std::move(table));
}

void costs(const ThreeMaps& maps, PaperReport& report) {
    const auto over = [&](Place one, Place other) { return maps.ns.ratio(one, other); };
    const Value finer = over(fine, coarse), finer_subset = over(fine_subset, coarse);
    const Readings both_finer{finer, finer_subset};
    const std::string finer_text =
        fmt::format("4096 map over 512 map, times: {} with 400 jittered samples, {} with a random subset of 400",
                    to_text(finer), to_text(finer_subset));
    report.claims.push_back(
        {"section 6, figure 6",
         "filtering takes much longer in the 4096 map with 400 samples than in the 512 map with 16", finer_text,
         in_readings(each_judged(both_finer, much_longer)),
         "Judged in both readings of how the samples are selected: section 2 stratifies them, section 6 writes of a "
         "random subset. 400 depths are 25 times as many as 16.",
         both_finer});
    report.claims.push_back(
        {"section 6, figure 6",
         "filtering takes 559 s in the 4096 map with 400 samples, and 19 s in the 512 map with 16: this one is 29 "
         "times faster",
         finer_text,
         in_readings(each_judged(both_finer, [](const Value& times) { return judge_gain(559.0 / 19.0, times); })),
         "The paper's seconds. Faster is a gain; in both readings.", both_finer});
    Readings faster, faster_than_subset, slower;
    for (const Place deep_map : deep_maps) {
        faster.push_back(over(fine, deep_map));
        faster_than_subset.push_back(over(fine_subset, deep_map));
        slower.push_back(over(deep_map, coarse));
    }
    const Readings all_faster = joined(faster, faster_than_subset);
    const std::string faster_text =
        fmt::format("4096 map over deep map, times: {}; with a random subset of 400 depths {}", text_of(faster),
                    text_of(faster_than_subset));
    report.claims.push_back(
        {"section 6, figure 6", "deep map lookups are much faster than those in the 4096 map with 400 samples",
         faster_text, in_readings(each_judged(all_faster, much_longer)),
         "Judged in the same readings as the paper's seconds below.", all_faster});
    report.claims.push_back(
        {"section 6, figure 6",
         "deep map lookups take 37 s where the 4096 map with 400 samples takes 559 s: 15 times faster", faster_text,
         in_readings(each_judged(all_faster, [](const Value& times) { return judge_gain(559.0 / 37.0, times); })),
         "The paper's seconds. Faster is a gain. Judged in all readings of the deep map's size, of its filter, and of "
         "how the 400 samples are selected, at the paper's settings: errors are not equal, see the quality below. A "
         "lookup searches 25 functions, or 9 of 256 x 256; by pixel centres 16, or 4.",
         all_faster});
    report.claims.push_back(
        {"section 6, figure 6",
         "deep map lookups take 37 s where the 512 map with 16 samples takes 19 s: 1.9 times slower",
         "deep map over 512 map, times: " + text_of(slower),
         in_readings(each_judged(slower, [](const Value& times) { return judge_ratio(37.0 / 19.0, times); })),
         "Judged in all readings of the deep map's size and filter, at the paper's settings: errors are not equal. A "
         "search costs more than a depth test.",
         slower});
    const Value depths = bytes_of(cell_of(light_of(maps.large), "pcf", {"placement=jittered"}));
    Readings share;
    for (const results::Result* deep : {&maps.printed, &maps.fewer_samples, &maps.fewer_pixels})
        share.push_back(bytes_of(published(*deep)) / depths);
    report.claims.push_back(
        {"section 6, figure 6", "the deep map needs one sixth of the 4096 map's storage",
         "deep map over 4096 map, bytes: " + text_of(share),
         in_readings(each_judged(share, [](const Value& size) { return judge_size(1.0 / 6.0, 1.0, size); })),
         "Judged in the three readings of its size, bytes held. As printed the deep map has four times as many depth "
         "samples.",
         share});
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
    Readings stored;
    for (const char* kernel : {"box", "pixels"})
        for (const results::Result* deep : {&maps.printed, &maps.fewer_samples, &maps.fewer_pixels})
            stored.push_back(error_of(published(*deep, kernel)));
    std::vector<Judged> better;
    for (const Value& depth_error : {jittered, subset})
        for (const Value& deep_error : stored) better.push_back(judge_less(deep_error, depth_error));
    report.claims.push_back(
        {"section 6, figure 6", "quality slightly better than the 4096 map, since every depth sample counts",
         fmt::format("error rms {}; 4096 map {} (400 jittered samples) and {} (a random subset of 400)",
                     text_of(stored), to_text(jittered), to_text(subset)),
         in_readings(better),
         "Judged in all readings of the deep map's size and filter, and against both ways to select samples: section 2 "
         "stratifies them.",
         joined(stored, {jittered, subset})});
}

}  // namespace

void three_maps(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    const ThreeMaps maps = run(context);
    add_table(maps, *context.report);
    costs(maps, *context.report);
    qualities(maps, *context.report);
}

}  // namespace shadowbench::claims::lokovic
