// Lokovic and Veach, Deep Shadow Maps, 2000: section 6, figure 9.
#include "claims/lokovic_filtering.h"

#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"
#include "bench/lookup_timing.h"
#include "claims/lokovic.h"
#include "claims/seeded_light.h"

namespace shadowbench::claims::lokovic {
namespace {

constexpr int all_widths[] = {1, 2, 4, 8, 16, 32};  // pixels of a map of 256 x 256
constexpr std::size_t narrowest = 0, first_level = 2, widest = std::size(all_widths) - 1;  // places in that list

// The maps, in the order of the scenario's techniques: the paper's deep map word for word, without and with mip levels;
// and a depth map of as many samples, filtered with 8 x 8 of them.
enum Map { plain, levelled, depth, map_count };
constexpr const char* map_names[] = {"deep map", "deep map with mip levels", "depth map, 8 x 8 samples"};

std::string all_maps() {
    const auto deep = [](const char* mip) {
        return fmt::format(R"({{"type":"deep","compression":"published","search":"cached","mip":"{}"}})", mip);
    };
    return set_techniques(deep("none") + "," + deep("nearest") + "," + pcf(64, "sample"));
}

std::size_t place(Map map, std::size_t width) {
    return width * map_count + map;
}

// Nanoseconds a lookup of receivers in image order, in runs of neighbours; see place().
Turns measure_widths(const Context& context) {
    const SeededLight light(context, ball_scene, {"rays.samples_per_pixel=64", all_maps()}, {"rays.resolution=128"});
    const std::vector<bench::Maps> maps = light.build(0);
    const bench::QuerySet image = light.queries();
    const bench::QuerySet chosen = bench::pick(image.asked(), bench::choose_runs(image.queries.size(), 4096));
    std::vector<std::vector<techniques::Query>> of_width(std::size(all_widths), chosen.queries);
    std::vector<TimedLookups> timed;
    for (std::size_t w = 0; w < std::size(all_widths); ++w) {
        for (techniques::Query& query : of_width[w])
            query.width = static_cast<float>(all_widths[w] / 256.0 * light.layout().width);
        for (const bench::Maps& map : maps) timed.push_back({&map, of_width[w]});
    }
    std::vector<Compared> compared{{place(depth, widest), place(depth, narrowest)},
                                   {place(levelled, widest), place(plain, widest)}};
    for (std::size_t w = 0; w < std::size(all_widths); ++w)
        for (std::size_t narrower = 0; narrower < w; ++narrower)
            compared.push_back({place(levelled, w), place(levelled, narrower)});
    return lookup_turns(timed, compared);
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

Table table_of(const Turns& times) {
    Table table{"Figure 9: ns a lookup over the filter width", {"width, share of the map"}, {}};
    for (const char* name : map_names) table.header.push_back(name);
    for (std::size_t w = 0; w < std::size(all_widths); ++w) {
        std::vector<std::string> row{fmt::format("{:.3g}", all_widths[w] / 256.0)};
        for (const Map map : {plain, levelled, depth}) row.push_back(to_text(times.time(place(map, w))));
        table.rows.push_back(std::move(row));
    }
    return table;
}

}  // namespace

void widths(const Context& context) {
    PaperReport& report = *context.report;
    const base::ThreadLimit threads(context.threads);
    const Turns times = measure_widths(context);
    report.plots.push_back(plot_of(times));
    report.tables.push_back(table_of(times));
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
