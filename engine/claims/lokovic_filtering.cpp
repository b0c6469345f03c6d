// Lokovic and Veach, Deep Shadow Maps, 2000: section 6, figure 9.
#include "claims/lokovic_filtering.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"
#include "bench/lookup_timing.h"
#include "claims/answers_over_seeds.h"
#include "claims/lokovic.h"
#include "claims/seeded_light.h"

namespace shadowbench::claims::lokovic {
namespace {

constexpr int all_widths[] = {1, 2, 4, 8, 16, 32};  // pixels of a map of 256 x 256
constexpr std::size_t narrowest = 0, first_level = 2, widest = std::size(all_widths) - 1;  // places in that list

// The maps, in the order of the scenario's techniques: the paper's deep map word for word, without and with mip levels;
// and a depth map of as many samples, filtered with 8 x 8 of them.
constexpr int samples = 64;
enum Map { plain, levelled, depth, map_count };
constexpr const char* map_names[] = {"deep map", "deep map with mip levels", "depth map, 8 x 8 samples"};

std::string all_maps() {
    const auto deep = [](const char* mip) {
        return fmt::format(R"({{"type":"deep","compression":"published","search":"cached","mip":"{}"}})", mip);
    };
    return set_techniques(deep("none") + "," + deep("nearest") + "," + pcf(samples, "sample"));
}

std::size_t place(Map map, std::size_t width) {
    return width * map_count + map;
}

// See place().
struct Measured {
    Turns ns;  // a lookup of receivers in image order, in runs of neighbours
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

Turns time_widths(const std::vector<bench::Maps>& maps, const bench::QuerySet& image, const SeededLight& light) {
    const bench::QuerySet chosen = bench::pick(image.asked(), bench::choose_runs(image.queries.size(), 4096));
    const std::vector<Queries> of_width = over_widths(chosen.queries, light);
    std::vector<TimedLookups> timed;
    for (const Queries& queries : of_width)
        for (const bench::Maps& map : maps) timed.push_back({&map, queries});
    std::vector<Compared> compared{{place(depth, widest), place(depth, narrowest)},
                                   {place(levelled, widest), place(plain, widest)}};
    for (std::size_t w = 0; w < std::size(all_widths); ++w)
        for (std::size_t narrower = 0; narrower < w; ++narrower)
            compared.push_back({place(levelled, w), place(levelled, narrower)});
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
            for (const Map map : {plain, levelled, depth})
                answers[place(map, w)].add(bench::lookup_all(maps[map], of_width[w]));
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
    return {time_widths(maps, image, light), errors_of_widths(maps, image, light)};
}

// How much the time of a map changes over all widths.
Value over_all_widths(const Turns& times, Map map) {
    std::vector<std::size_t> of;
    for (std::size_t w = 0; w < std::size(all_widths); ++w) of.push_back(place(map, w));
    return times.spread(of);
}

Plot plot_of(const Turns& times) {
    Plot plot{"lokovic2000_figure9",
              "Figure 9: lookup time over filter width",
              "filter width, share of the map",
              "ns a lookup",
              true,
              true,
              {}};
    for (const Map map : {depth, plain, levelled}) {
        Series series{map_names[map], {}, true};
        for (std::size_t w = 0; w < std::size(all_widths); ++w)
            series.points.emplace_back(all_widths[w] / 256.0, times.time(place(map, w)).value);
        plot.series.push_back(std::move(series));
    }
    return plot;
}

Table table_of(const Measured& measured) {
    Table table{"Figure 9: ns a lookup, and error rms, over the filter width", {"width, share of the map"}, {}};
    for (const char* name : map_names) table.header.push_back(fmt::format("{}, ns", name));
    for (const char* name : map_names) table.header.push_back(fmt::format("{}, rms", name));
    for (std::size_t w = 0; w < std::size(all_widths); ++w) {
        std::vector<std::string> row{fmt::format("{:.3g}", all_widths[w] / 256.0)};
        for (const Map map : {plain, levelled, depth}) row.push_back(to_text(measured.ns.time(place(map, w))));
        for (const Map map : {plain, levelled, depth}) row.push_back(to_text(measured.error[place(map, w)]));
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
        text += fmt::format("{}{}: ", text.empty() ? "" : "; ", map_names[map]);
        for (std::size_t w = 0; w < std::size(all_widths); ++w) {
            const Value error = measured.error[place(map, w)];
            within.push_back(judge_less(error, exactly(level)));
            values.push_back(error);
            text += (w == 0 ? "" : ", ") + to_text(error);
        }
    }
    report.claims.push_back({"section 6, figure 9",
                             "a fixed accuracy needs no more samples, and no finer level, as the filter gets wider",
                             fmt::format("error rms over all widths, {}", text), in_all(within),
                             fmt::format("Each error is compared with 0.5 / sqrt N = {:.3g}, the worst-case expected "
                                         "error of {} samples. Errors of the two maps are not equal.",
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
                of_levels = over_all_widths(times, levelled),
                at_last = times.ratio(place(levelled, widest), place(levelled, narrowest)),
                of_coarse = times.ratio(place(levelled, widest), place(levelled, first_level)),
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
         fmt::format("the slowest of all widths takes {} times as long as the fastest; the widest {} times as long as "
                     "the narrowest",
                     to_text(of_levels), to_text(at_last)),
         judge_constant(of_levels),
         "Judged over all widths of the table. A filter one pixel wide reads at most 2 x 2 pixels of the map, the "
         "others at most 3 x 3 pixels of one level.",
         {of_levels, at_last}});
    report.claims.push_back(
        {"section 6, figure 9",
         "in theory the cache performance of deep maps is better at very large filter widths, since coarse levels have "
         "fewer pixels",
         fmt::format("the widest filter takes {} times as long as one of a 64th of the map", to_text(of_coarse)),
         judge_less(of_coarse, exactly(1.0)),
         "Both read at most 3 x 3 pixels of one coarser level. The functions of the coarsest levels have more vertices "
         "to search.",
         {of_coarse}});
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
