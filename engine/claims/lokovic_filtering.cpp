// Lokovic and Veach, Deep Shadow Maps, 2000: section 6, figure 9.
#include "claims/lokovic_filtering.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"
#include "bench/lookup_timing.h"
#include "claims/answers_over_seeds.h"
#include "claims/lokovic.h"
#include "claims/seeded_light.h"
#include "techniques/deep/deep.h"
#include "techniques/deep/footprint.h"

namespace shadowbench::claims::lokovic {
namespace {

constexpr int all_widths[] = {1, 2, 4, 8, 16, 32};  // pixels of a map of 256 x 256
constexpr std::size_t narrowest = 0, equal_reads = 1, first_level = 2,
                      widest = std::size(all_widths) - 1;  // places in that list

// The maps, in the order of the scenario's techniques: the paper's deep map word for word, without and with mip levels;
// the same with levels, whose pixels are weighted by their centres; and a depth map of as many samples, filtered with
// 8 x 8 of them. With a tent as wide as a pixel of its level, which all these widths are, a lookup reads 2 x 2 pixels
// of one level, whatever its width.
constexpr int samples = 64;
enum Map { plain, levelled, by_centres, depth, map_count };
constexpr Map every_map[] = {plain, levelled, by_centres, depth};
constexpr const char* map_names[] = {"deep map", "deep map with mip levels",
                                     "deep map with mip levels, tent by centres", "depth map, 8 x 8 samples"};

std::string all_maps() {
    const auto deep = [](const char* mip, const char* kernel) {
        return fmt::format(R"({{"type":"deep","compression":"published","search":"cached","mip":"{}","kernel":"{}"}})",
                           mip, kernel);
    };
    return set_techniques(deep("none", "box") + "," + deep("nearest", "box") + "," + deep("nearest", "tent") + "," +
                          pcf(samples, "sample"));
}

std::size_t place(Map map, std::size_t width) {
    return width * map_count + map;
}

// See place().
struct Measured {
    Turns ns;                   // a lookup of receivers in image order, in runs of neighbours
    std::vector<double> reads;  // pixels, or depths, that these lookups read: means
    std::vector<Value> error;
};

using Queries = std::vector<techniques::Query>;

// The same queries, with each of the widths.
std::vector<Queries> over_widths(const Queries& queries, const SeededLight& light) {
    std::vector<Queries> all(std::size(all_widths), queries);
    for (std::size_t w = 0; w < std::size(all_widths); ++w)
        for (techniques::Query& query : all[w])
            query.width = static_cast<float>(all_widths[w] / 256.0 * light.layout().width);
    return all;
}

// The mean number of pixels of one level that a lookup reads in a deep map.
double mean_reads(const Queries& queries, const bench::Maps& map, const techniques::LookupRule& rule) {
    const std::span<const techniques::DeepLevel> all = techniques::levels(*map.parts.front());
    double reads = 0.0;
    for (const techniques::Query& query : queries) {
        const int level = techniques::choose_levels(rule, query.width, all.size()).fine;
        techniques::for_each_pixel(all[0].width, all[0].height, level, rule.kernel, query,
                                   [&](int, int, double) { reads += 1.0; });
    }
    return reads / static_cast<double>(queries.size());
}

std::vector<double> reads_of_widths(const std::vector<bench::Maps>& maps, const std::vector<Queries>& of_width) {
    using techniques::Kernel, techniques::Mip;
    std::vector<double> reads;
    for (const Queries& queries : of_width) {
        reads.push_back(mean_reads(queries, maps[plain], {.kernel = Kernel::box, .mip = Mip::none}));
        reads.push_back(mean_reads(queries, maps[levelled], {.kernel = Kernel::box, .mip = Mip::nearest}));
        reads.push_back(mean_reads(queries, maps[by_centres], {.kernel = Kernel::tent, .mip = Mip::nearest}));
        reads.push_back(samples);
    }
    return reads;
}

Turns time_widths(const std::vector<bench::Maps>& maps, const std::vector<Queries>& of_width) {
    std::vector<TimedLookups> timed;
    for (const Queries& queries : of_width)
        for (const bench::Maps& map : maps) timed.push_back({&map, queries});
    std::vector<Compared> compared{{place(depth, widest), place(depth, narrowest)},
                                   {place(levelled, widest), place(plain, widest)}};
    for (const Map map : {levelled, by_centres})
        for (std::size_t w = 0; w < std::size(all_widths); ++w)
            for (std::size_t narrower = 0; narrower < w; ++narrower)
                compared.push_back({place(map, w), place(map, narrower)});
    return lookup_turns(timed, compared);
}

// `first`: the maps of the scenario's own seed.
std::vector<Value> errors_of_widths(const std::vector<bench::Maps>& first, const bench::QuerySet& image,
                                    const SeededLight& light) {
    const bench::QuerySet judged = bench::pick(image.asked(), bench::choose_judged(image.queries.size(), 2048, 1));
    const std::vector<Queries> of_width = over_widths(judged.queries, light);
    std::vector<bench::Truth> truths;
    for (const Queries& queries : of_width) truths.push_back(light.truth(queries));
    std::vector<AnswersOverSeeds> answers;
    for (const bench::Truth& truth : truths)
        for (int map = 0; map < map_count; ++map) answers.emplace_back(truth);
    const auto add = [&](const std::vector<bench::Maps>& maps) {
        for (std::size_t w = 0; w < of_width.size(); ++w)
            for (const Map map : every_map) answers[place(map, w)].add(bench::lookup_all(maps[map], of_width[w]));
    };
    add(first);
    for (int seed = 1; seed < ray_seeds; ++seed) add(light.build(seed));
    std::vector<Value> errors;
    for (const AnswersOverSeeds& one : answers) errors.push_back(one.rms());
    return errors;
}

Measured measure_widths(const Context& context) {
    const SeededLight light(
        context, ball_scene,
        {fmt::format("rays.samples_per_pixel={}", samples), "reference.samples_per_pixel=64", all_maps()},
        {"rays.resolution=128"});
    const std::vector<bench::Maps> maps = light.build(0);
    const bench::QuerySet image = light.queries();
    const bench::QuerySet chosen = bench::pick(image.asked(), bench::choose_runs(image.queries.size(), 4096));
    const std::vector<Queries> of_width = over_widths(chosen.queries, light);
    return {time_widths(maps, of_width), reads_of_widths(maps, of_width), errors_of_widths(maps, image, light)};
}

// How much the time of a map grows over the widths from this one on.
Value over_widths_from(const Turns& times, Map map, std::size_t first) {
    std::vector<std::size_t> of;
    for (std::size_t w = first; w < std::size(all_widths); ++w) of.push_back(place(map, w));
    return times.growth(of);
}

// "8.5 to 9 pixels read": the least and the most, on average, over the widths from this one on.
std::string reads_text(const Measured& measured, Map map, std::size_t first) {
    double least = measured.reads[place(map, first)], greatest = least;
    for (std::size_t w = first; w < std::size(all_widths); ++w) {
        least = std::min(least, measured.reads[place(map, w)]);
        greatest = std::max(greatest, measured.reads[place(map, w)]);
    }
    return fmt::format("{:.3g} to {:.3g} pixels read", least, greatest);
}

// What the widest filter reads over what the first of a coarser level does.
double fewer_reads(const Measured& measured, Map map) {
    return measured.reads[place(map, widest)] / measured.reads[place(map, first_level)];
}

Plot plot_of(const Turns& times) {
    Plot plot{"lokovic2000_figure9",
              "Figure 9: lookup time over filter width",
              "filter width, share of the map",
              "ns a lookup",
              true,
              true,
              {}};
    for (const Map map : {depth, plain, levelled, by_centres}) {
        Series series{map_names[map], {}, true};
        for (std::size_t w = 0; w < std::size(all_widths); ++w)
            series.points.emplace_back(all_widths[w] / 256.0, times.time(place(map, w)).value);
        plot.series.push_back(std::move(series));
    }
    return plot;
}

Table table_of(const Measured& measured) {
    Table table{
        "Figure 9: ns a lookup, what it reads, and error rms, over the filter width", {"width, share of the map"}, {}};
    for (const char* name : map_names) table.header.push_back(fmt::format("{}, ns", name));
    for (const char* name : map_names) table.header.push_back(fmt::format("{}, reads", name));
    for (const char* name : map_names) table.header.push_back(fmt::format("{}, rms", name));
    for (std::size_t w = 0; w < std::size(all_widths); ++w) {
        std::vector<std::string> row{fmt::format("{:.3g}", all_widths[w] / 256.0)};
        for (const Map map : every_map) row.push_back(to_text(measured.ns.time(place(map, w))));
        for (const Map map : every_map) row.push_back(fmt::format("{:.3g}", measured.reads[place(map, w)]));
        for (const Map map : every_map) row.push_back(to_text(measured.error[place(map, w)]));
        table.rows.push_back(std::move(row));
    }
    return table;
}

// The accuracy that the figure fixes is the worst-case expected error of the samples, as in figure 7.
void accuracy(const Measured& measured, PaperReport& report) {
    const double level = 0.5 / std::sqrt(static_cast<double>(samples));
    std::vector<Judged> within;
    std::vector<Value> values;
    std::string text;
    for (const Map map : {depth, levelled}) {
        text += fmt::format("{}{}: ", text.empty() ? "" : "; not judged, ", map_names[map]);
        for (std::size_t w = 0; w < std::size(all_widths); ++w) {
            const Value error = measured.error[place(map, w)];
            if (map == depth) within.push_back(judge_less(error, exactly(level)));
            values.push_back(error);
            text += (w == 0 ? "" : ", ") + to_text(error);
        }
    }
    report.claims.push_back(
        {"section 6, figure 9",
         "the number of filter samples of a depth map can be held fixed for a fixed accuracy as the filter gets wider",
         fmt::format("error rms over all widths, {}", text), in_all(within),
         fmt::format("Each error of the depth map is compared with 0.5 / sqrt N = {:.3g}, the worst-case expected "
                     "error of {} samples. The deep map stands beside it, with pixels weighted by their covered part, "
                     "as the truth's filter is a box of the width; errors of the two maps are not equal.",
                     level, samples),
         std::move(values)});
}

}  // namespace

void widths(const Context& context) {
    PaperReport& report = *context.report;
    const base::ThreadLimit threads(context.threads);
    const Measured measured = measure_widths(context);
    const Turns& times = measured.ns;
    report.plots.push_back(plot_of(times));
    report.tables.push_back(table_of(measured));
    accuracy(measured, report);
    const Value of_depth = times.ratio(place(depth, widest), place(depth, narrowest)),
                of_levels = over_widths_from(times, levelled, equal_reads),
                of_centres = over_widths_from(times, by_centres, narrowest),
                with_narrowest = over_widths_from(times, levelled, narrowest),
                ends = times.ratio(place(levelled, widest), place(levelled, equal_reads)),
                ends_by_centres = times.ratio(place(by_centres, widest), place(by_centres, narrowest)),
                of_coarse = times.ratio(place(levelled, widest), place(levelled, first_level)),
                coarse_centres = times.ratio(place(by_centres, widest), place(by_centres, first_level)),
                saved = times.ratio(place(levelled, widest), place(plain, widest));
    report.claims.push_back(
        {"section 6, figure 9",
         "depth map filtering time grows rapidly with width, at 8 x 8 samples",
         fmt::format("the widest filter takes {} times as long as the narrowest", to_text(of_depth)),
         judge_growth(of_depth),
         "The paper's growth is cache misses; here the whole map may stay in the cache.",
         {of_depth}});
    report.claims.push_back(
        {"section 6, figure 9",
         "with mip levels deep filtering time is virtually constant in width",
         fmt::format("a wider filter takes at most {} times as long as a narrower one, and the widest {} times as long "
                     "as the narrowest, pixels weighted by their covered part, widths from 2 pixels of the map on, {}; "
                     "{} and {} times, a tent over pixel centres, all widths, {}; at most {} times, covered parts, all "
                     "widths, {}",
                     to_text(of_levels), to_text(ends), reads_text(measured, levelled, equal_reads),
                     to_text(of_centres), to_text(ends_by_centres), reads_text(measured, by_centres, narrowest),
                     to_text(with_narrowest), reads_text(measured, levelled, narrowest)),
         in_readings({judge_constant(of_levels), judge_constant(of_centres)}),
         "The figure's caption has both methods access a constant number of pixels per lookup. Judged is how much the "
         "time grows with the width, in two readings of the filter, over the widths for which that is so here; below 1 "
         "it falls, and the caption has deep maps become slightly better with the width. The last number is not "
         "judged, since a filter one pixel wide reads fewer pixels by its covered parts.",
         {of_levels, ends, of_centres, ends_by_centres, with_narrowest}});
    report.claims.push_back(
        {"section 6, figure 9",
         "in theory the cache performance of deep maps is better at very large filter widths, since coarse levels have "
         "fewer pixels",
         fmt::format("the widest filter takes {} times as long as one of a 64th of the map, {} times by a tent over "
                     "pixel centres",
                     to_text(of_coarse), to_text(coarse_centres)),
         in_readings({judge_less(of_coarse, exactly(1.0)), judge_less(coarse_centres, exactly(1.0))}),
         fmt::format("Both widths read pixels of one coarser level, the widest {:.3g} and {:.3g} times as many as the "
                     "other. The functions of the coarsest levels have more vertices to search. Two readings of the "
                     "filter.",
                     fewer_reads(measured, levelled), fewer_reads(measured, by_centres)),
         {of_coarse, coarse_centres}});
    report.claims.push_back(
        {"section 1",
         "mip-mapping can dramatically reduce lookup costs over a wide range of scales",
         fmt::format("at the widest filter, an eighth of the map, {} times the time of the same map without levels",
                     to_text(saved)),
         judge_much_less(saved, exactly(1.0)),
         "Without levels a lookup reads every pixel under the filter.",
         {saved}});
}

void filtering(const Context& context) {
    widths(context);
    levels(context);
    blends(context);
    footprints(context);
    tiles(context);
}

}  // namespace shadowbench::claims::lokovic
