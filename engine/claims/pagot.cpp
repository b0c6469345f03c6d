// Pagot, Comba, Oliveira, Multiple-Depth Shadow Maps, 2004: table 1 and figure 3, and the order of the other parts.
#include "claims/pagot.h"

#include <array>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "claims/hand_made.h"
#include "claims/pagot_views.h"
#include "claims/sheet.h"

namespace shadowbench::claims {
namespace {

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
    std::array<int, 2> smoother{0, 0};  // outcomes of PCF(9, 2) and of PCF(16, 1)
    for (const int side : {1, 2, 3, 4, 5}) {
        std::vector<std::string> row{std::to_string(side * side)};
        for (int n = 1; n <= 8; ++n) {
            const int most = n * side * side + 1, seen = outcomes_of(side, n);
            row.push_back(fmt::format("{} / {}", seen, most));
            if (side == 3 && n == 2) smoother[0] = seen;
            if (side == 4 && n == 1) smoother[1] = seen;
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
                             "Counted over 400,000 lookups in a map of random depths. To keep up to 8 depths a cell, "
                             "they are spread over the sorted depths of 5 x 5 cells (select=sorted, q=25).",
                             {exactly(exact), exactly(over)}});
    const int many = smoother[0] == 19, few = smoother[1] == 17;
    report.claims.push_back({"section 4.2",
                             "PCF(9, 2) makes up to 19 outcomes and PCF(16, 1) up to 17: 11.7 % more with 56 % of the "
                             "samples, which can make borders smoother",
                             fmt::format("{} and {}", smoother[0], smoother[1]),
                             judge_count(many + few, (smoother[0] > 19) + (smoother[1] > 17), 2),
                             "Counted in the same maps. How smooth borders are in pictures is what the claim about "
                             "aliasing measures.",
                             {exactly(smoother[0]), exactly(smoother[1])}});
}

}  // namespace

namespace pagot {

std::string title(const Kernel& kernel) {
    return fmt::format("{0}-SM with {1} x {1}", kernel.n, kernel.side);
}

std::string request(const Kernel& kernel) {
    return fmt::format(R"({{"type":"multi_depth","n":{},"select":"{}","kernel":{}}})", kernel.n,
                       kernel.n == 3 ? "both" : "maximum", kernel.side);
}

}  // namespace pagot

void measure_pagot(const Context& context) {
    context.report->conditions = fmt::format(
        "Scenes of flat and curved receivers under a spot light, {0} x {0} cells of one regular ray; second and third "
        "depths are the maximum and the minimum of 3 x 3 cells. The paper's scenes are not public, and it gives no "
        "views: what is compared by pictures is measured under {1} lights, {2} degrees apart around the scene, each "
        "with a close view and a place of the map's cells of its own; numbers are means over these with their "
        "intervals. The paper compares pictures by eye. Here the shaded pictures are compared, pixel by pixel, of the "
        "plane in the flat scene and of all else in the curved one: their rms difference, and FLIP's mean (Andersson "
        "et al. 2020), which weighs differences as an eye does. Errors and transitions are of visibility, where "
        "surfaces face the light: balls so much that no kernel and no footprint reaches the ball's own surface beyond "
        "the bias, so that what a ball seems to shade of itself is no transition. "
        "Times are of the flat scene as committed, medians over rounds on one thread, where the paper used a GPU. "
        "Table 1 keeps other depths; its claim says which. Hardware that selects depths (section 4.4), and fetching "
        "several depths with one access to a texture (section 5), are not tested.",
        context.quick ? 256 : 512, pagot::lights, 360 / pagot::lights);
    table_1(context);
    pagot::pictures(context);
    pagot::crossing(context);
    pagot::costs(context);
    context.report->sheets.push_back(picture_sheet(context, pagot::flat, {}));
}

}  // namespace shadowbench::claims
