// Reeves, Salesin, Cook 1987: figures 6, 7, 8 and 10, and the jitter that figure 4 prints.
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "claims/hand_made.h"
#include "claims/intervals.h"
#include "claims/reeves.h"

namespace shadowbench::claims::reeves {
namespace {

using results::Cell;
using results::LightResult;

// MinSize and MinSamples as figure 4 prints them, so that a single sample is possible as in figure 7.
std::string printed(int samples) {
    return fmt::format(R"({{"type":"pcf","num_samples":{},"res_factor":1,"min_size":0,"min_samples":1}})", samples);
}

void figures_6_and_7(const Context& context) {
    const results::Result result = context.run(
        sphere, {fmt::format(R"(techniques=[{{"type":"shadow_map"}},{},{},{}])", printed(1), printed(4), printed(16))},
        {}, Times::taken);
    const LightResult& light = light_of(result);
    const auto pcf = [&](int samples) -> const Cell& {
        return cell_of(light, "pcf", {fmt::format("num_samples={}", samples)});
    };
    const Value hard = error_of(cell_of(light, "shadow_map")), one = error_of(pcf(1)), four = error_of(pcf(4)),
                sixteen = error_of(pcf(16));
    context.report->claims.push_back(
        {"section 4.1, figure 6",
         "percentage closer filtering antialiases the edges of the depth map",
         fmt::format("error rms {} against {} of point sampling", to_text(sixteen), to_text(hard)),
         judge_much_less(sixteen, hard),
         "Against the exact visibility over the same region.",
         {sixteen, hard}});
    const Value cost = time_ratio(pcf(16), pcf(1));
    context.report->claims.push_back(
        {"section 4.2, figure 7",
         "more samples make edges less noisy and cost more",
         fmt::format("error rms {}, {}, {} with 1, 4, 16 samples; 16 take {} times as long as 1", to_text(one),
                     to_text(four), to_text(sixteen), to_text(cost)),
         both(both(judge_less(four, one), judge_less(sixteen, four)), judge_less(exactly(1.0), cost)),
         "The numbers of samples of the figure, with its MinSamples of 1. The paper says \"better but more "
         "expensive\", and gives no size.",
         {one, four, sixteen, cost}});
}

// Lookups across the straight edge of an opaque half-plane at x = 64 of a map of 128 x 128 cells.
struct Edge {
    double width;  // cells, from 10 to 90 % lit
    double place;  // cells, where it is half lit on average
};

Edge edge(double res_factor, const char* placement, std::uint64_t repeat) {
    rays::LightRays tile;
    tile.width = tile.height = 128;
    tile.begin.push_back(0);
    for (int ray = 0; ray < 128 * 128; ++ray) {
        if (ray % 128 < 64) {
            tile.z_front.push_back(1.0f);
            tile.transmittance.push_back(0.0f);
        }
        tile.begin.push_back(static_cast<std::uint32_t>(tile.z_front.size()));
    }
    const nlohmann::json parameters = {
        {"res_factor", res_factor}, {"num_samples", 64}, {"min_size", 0}, {"placement", placement}};
    constexpr int columns = 480, rows = 64;
    constexpr double step = 0.125, first = 34.0 + 0.5 * step;
    base::Random random(base::hash(repeat, 8));
    const float up = static_cast<float>(random.uniform());
    std::vector<techniques::Query> queries;
    for (int x = 0; x < columns; ++x)
        for (int y = 0; y < rows; ++y)
            queries.push_back({static_cast<float>(first + step * x), 32.0f + up + static_cast<float>(y), 2.0f, 1.0f});
    const std::vector<float> visibility = look_up("pcf", parameters, tile, 3.0f, queries);
    Edge found{0.0, 34.0 + step * columns};
    for (int x = 0; x < columns; ++x) {
        double mean = 0.0;
        for (int y = 0; y < rows; ++y) mean += visibility[static_cast<std::size_t>(x * rows + y)] / rows;
        if (mean > 0.1 && mean < 0.9) found.width += step;
        found.place -= step * mean;
    }
    return found;
}

struct Edges {
    Value width, place;
};

// Over eight repeats: other positions along the edge, and so other random numbers.
Edges edges_of(double res_factor, const char* placement) {
    std::vector<double> widths, places;
    for (std::uint64_t repeat = 0; repeat < 8; ++repeat) {
        const Edge found = edge(res_factor, placement, repeat);
        widths.push_back(found.width);
        places.push_back(found.place);
    }
    return {mean_of(widths), mean_of(places)};
}

void figures_4_and_8(PaperReport& report) {
    constexpr double factors[] = {1, 3, 8};
    std::vector<Value> widths;
    Table table{"Figure 4: where a shadow's straight edge lies, in cells from its true place; means over eight places "
                "along the edge",
                {"ResFactor", "width (10 to 90 %)", "samples anywhere in their parts", "samples as printed"},
                {}};
    for (const double factor : factors) {
        const Edges spread = edges_of(factor, "jittered"), published = edges_of(factor, "published");
        widths.push_back(spread.width);
        const auto moved = [](const Edges& edges) { return to_text(edges.place - exactly(64.0)); };
        table.rows.push_back({fmt::format("{:g}", factor), to_text(spread.width), moved(spread), moved(published)});
    }
    report.tables.push_back(std::move(table));
    report.claims.push_back({"section 4.2, figure 8", "increasing ResFactor produces softer shadow edges",
                             fmt::format("edges are {}, {}, {} cells wide (10 to 90 %) with ResFactor 1, 3, 8",
                                         to_text(widths[0]), to_text(widths[1]), to_text(widths[2])),
                             both(judge_growth(widths[1] / widths[0]), judge_growth(widths[2] / widths[1])),
                             "The width of the region is the width of the edge.", widths});
}

// The filter keeps its width in the world: four cells of the largest map.
void figure_10(const Context& context) {
    std::vector<Value> errors;
    for (const int resolution : {256, 512, 1024}) {
        const results::Result result = context.run(sphere,
                                                   {fmt::format("rays.resolution={}", resolution),
                                                    fmt::format("receivers.filter_width={}", 4.0 * resolution / 1024.0),
                                                    R"(techniques=[{"type":"pcf","num_samples":16,"res_factor":1}])"},
                                                   {});
        errors.push_back(error_of(cell_of(light_of(result), "pcf")));
    }
    context.report->claims.push_back({"section 4.2, figure 10",
                                      "depth maps that are too small make shadows blurry and noisy",
                                      fmt::format("error rms {}, {}, {} at 256, 512, 1024", to_text(errors[0]),
                                                  to_text(errors[1]), to_text(errors[2])),
                                      both(judge_less(errors[1], errors[0]), judge_less(errors[2], errors[1])),
                                      "MinSize keeps the region at four cells, however large these are.", errors});
}

}  // namespace

void edges(const Context& context) {
    figures_6_and_7(context);
    figures_4_and_8(*context.report);
    figure_10(context);
}

}  // namespace shadowbench::claims::reeves
