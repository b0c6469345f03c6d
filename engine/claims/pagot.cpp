// Pagot, Comba, Oliveira, Multiple-Depth Shadow Maps, 2004: table 1, figures 3, 6 and 7, section 6.
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "claims/hand_made.h"
#include "claims/paper.h"
#include "claims/sheet.h"

namespace shadowbench::claims {
namespace {

using results::Cell;
using results::LightResult;

// The number of different answers that lookups give at 400,000 places and depths of a map of 128 x 128 random depths.
int outcomes_of(int side, int n) {
    rays::LightRays tile;
    tile.width = tile.height = 128;
    for (std::uint32_t ray = 0; ray <= 128u * 128u; ++ray) tile.begin.push_back(ray);
    for (std::uint64_t ray = 0; ray < 128u * 128u; ++ray) {
        tile.z_front.push_back(static_cast<float>(1.0 + base::to_unit(base::hash(1, ray))));
        tile.transmittance.push_back(0.0f);
    }
    const nlohmann::json parameters = {{"n", n}, {"select", "sorted"}, {"q", 25}, {"kernel", side}};
    std::vector<techniques::Query> queries;
    for (std::uint64_t i = 0; i < 400000; ++i)
        queries.push_back({static_cast<float>(8.0 + 112.0 * base::to_unit(base::hash(2, i))),
                           static_cast<float>(8.0 + 112.0 * base::to_unit(base::hash(3, i))),
                           static_cast<float>(0.95 + 1.1 * base::to_unit(base::hash(4, i))), 1.0f});
    const std::vector<float> visibility = look_up("multi_depth", parameters, tile, 2.0f, queries);
    std::set<int> seen;  // in millionths: outcomes are at least 1 / 200 apart
    for (const float v : visibility) seen.insert(static_cast<int>(v * 1e6f + 0.5f));
    return static_cast<int>(seen.size());
}

void table_1(const Context& context) {
    PaperReport& report = *context.report;
    Table table{"Table 1: distinct outcomes of PCF(k, n), measured / n k + 1", {"k \\ n"}, {}};
    for (int n = 1; n <= 8; ++n) table.header.push_back(std::to_string(n));
    Plot plot{"pagot2004_figure3", "Outcomes of PCF(k, n)", "samples k", "outcomes", false, false, {}};
    for (int n = 1; n <= 4; ++n) plot.series.push_back({fmt::format("n = {}", n), {}, true});
    int exact = 0, over = 0, entries = 0;
    for (const int side : {1, 2, 3, 4, 5}) {
        std::vector<std::string> row{std::to_string(side * side)};
        for (int n = 1; n <= 8; ++n) {
            const int most = n * side * side + 1, seen = outcomes_of(side, n);
            row.push_back(fmt::format("{} / {}", seen, most));
            exact += seen == most;
            over += seen > most;
            ++entries;
            if (n <= 4) plot.series[static_cast<std::size_t>(n - 1)].points.emplace_back(side * side, seen);
        }
        table.rows.push_back(std::move(row));
    }
    report.tables.push_back(std::move(table));
    report.plots.push_back(std::move(plot));
    report.claims.push_back({"section 4.2, table 1",
                             "PCF(k, n) has up to n k + 1 distinct outcomes",
                             fmt::format("reached exactly in {} of {} entries, exceeded in {}", exact, entries, over),
                             judge_count(exact, over, entries),
                             "Counted over 400,000 lookups in a map of random depths.",
                             {exactly(exact), exactly(over)}});
}

const Cell& kernel(const LightResult& light, int n, int side) {
    return cell_of(light, "multi_depth", {fmt::format("n={}", n), fmt::format("kernel={}", side)});
}

// Compares the smaller kernel on more depths with the larger one on a single depth.
void compare(const LightResult& light, const char* place, int n, int small, int large, PaperReport& report) {
    const Cell &ours = kernel(light, n, small), &theirs = kernel(light, 1, large);
    report.claims.push_back({place,
                             fmt::format("{0}-SM with {1} x {1} looks like 1-SM with {2} x {2}", n, small, large),
                             fmt::format("error rms {} against {}; {} times the time", to_text(error_of(ours)),
                                         to_text(error_of(theirs)), to_text(time_of(ours) / time_of(theirs))),
                             judge_alike(error_of(ours), error_of(theirs)),
                             "Errors against the exact visibility over four cells; the paper compares pictures with "
                             "each other by eye.",
                             {error_of(ours), error_of(theirs)}});
}

// Section 6: selecting a second depth costs q samples a cell and saves r kernel samples a fragment. So two depths pay
// if there are more than q / r fragments a cell.
void crossing(const LightResult& light, PaperReport& report) {
    const double q = 9.0, r = 16.0 - 9.0, predicted = q / r;
    const double cells = static_cast<double>(light.layout.width) * light.layout.height;
    const Value select = 1e6 * (of(kernel(light, 2, 3).times->build_ms) - of(kernel(light, 1, 4).times->build_ms));
    const Value saved = time_of(kernel(light, 1, 4)) - time_of(kernel(light, 2, 3));
    const bool pays = saved.low > 0.0 && select.low > 0.0;
    const Value fragments = pays ? (1.0 / cells) * (select / saved) : Value{};
    Judged judged = judge_ratio(predicted, fragments);
    if (!pays) judged.verdict = saved.high <= 0.0 ? Verdict::fails : Verdict::undecided;
    report.claims.push_back(
        {"section 6",
         fmt::format("2-SM with 3 x 3 beats 1-SM with 4 x 4 beyond {:.2f} fragments a cell (q = 9, r = 7)", predicted),
         pays ? fmt::format("beyond {} fragments a cell: selection {} ns a cell, {} ns saved a lookup",
                            to_text(fragments), to_text((1.0 / cells) * select), to_text(saved))
              : fmt::format("no crossing is measured: selection {} ns a cell, {} ns saved a lookup",
                            to_text((1.0 / cells) * select), to_text(saved)),
         judged,
         "The paper counts only texture fetches; comparing a depth has a cost too.",
         {fragments}});
}

}  // namespace

void measure_pagot(const Context& context) {
    context.report->conditions = fmt::format(
        "Scenes of flat and curved receivers under a spot light, {0} x {0} cells of one regular ray; second and third "
        "depths are the maximum and the minimum of 3 x 3 cells. The paper judged pictures by eye; here errors are "
        "against the exact visibility.",
        context.quick ? 256 : 512);
    table_1(context);
    const results::Result flat = context.run("pagot2004_flat", {}, {"rays.resolution=256"});
    compare(light_of(flat), "section 5, figure 6", 3, 2, 3, *context.report);
    compare(light_of(flat), "section 5, figure 6", 3, 3, 4, *context.report);
    const results::Result curved = context.run("pagot2004_curved", {}, {"rays.resolution=256"});
    compare(light_of(curved), "section 5, figure 7", 2, 3, 4, *context.report);
    compare(light_of(curved), "section 5, figure 7", 3, 3, 4, *context.report);
    crossing(light_of(flat), *context.report);
    context.report->sheets.push_back(picture_sheet(context, "pagot2004_flat", {}));
}

}  // namespace shadowbench::claims
