// Reeves, Salesin, Cook 1987: figures 3, 6, 7, 8 and 10, and the jitter that figure 4 prints.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "claims/hand_made.h"
#include "claims/intervals.h"
#include "claims/reeves.h"
#include "claims/seen.h"

namespace shadowbench::claims::reeves {
namespace {

using results::Cell;
using results::LightResult;

constexpr std::uint64_t map_places = 3;  // of the map's cells against the scene

// These settings of the sphere and plane, with the cells at another place.
std::vector<std::string> moved(const Context& context, std::uint64_t place, std::vector<std::string> set) {
    const nlohmann::json document = with_moved_map(context.document(sphere, set), place);
    set.push_back("/lights/0/target=" + document.at("lights").at(0).at("target").dump());
    return set;
}

// MinSize and MinSamples as figure 4 prints them, so that a single sample is possible as in figure 7.
std::string printed(int samples, int res_factor = 1) {
    return fmt::format(R"({{"type":"pcf","num_samples":{},"res_factor":{},"min_size":0,"min_samples":1}})", samples,
                       res_factor);
}

const Cell& printed_cell(const LightResult& light, int samples, int res_factor = 1) {
    return cell_of(light, "pcf", {fmt::format("num_samples={}", samples), fmt::format("res_factor={}", res_factor)});
}

// The errors of point sampling, and of regions with 1, 4 and 16 samples.
struct Errors {
    std::vector<double> hard, one, four, sixteen;  // [place]

    void add(const LightResult& light) {
        hard.push_back(error_of(cell_of(light, "shadow_map")).value);
        one.push_back(error_of(printed_cell(light, 1)).value);
        four.push_back(error_of(printed_cell(light, 4)).value);
        sixteen.push_back(error_of(printed_cell(light, 16)).value);
    }
};

void figures_6_and_7(const Context& context) {
    const std::vector<std::string> set{fmt::format(R"(techniques=[{{"type":"shadow_map"}},{},{},{},{}])", printed(1),
                                                   printed(4), printed(16), printed(16, 8))};
    const results::Result timed = context.run(sphere, moved(context, 0, set), {}, Times::taken);
    Errors errors;
    errors.add(light_of(timed));
    for (std::uint64_t place = 1; place < map_places; ++place)
        errors.add(light_of(context.run(sphere, moved(context, place, set), {})));
    const Value hard = mean_of(errors.hard), one = mean_of(errors.one), four = mean_of(errors.four),
                sixteen = mean_of(errors.sixteen);
    context.report->claims.push_back(
        {"section 4.1, figure 6",
         "percentage closer filtering antialiases the edges of the depth map",
         fmt::format("error rms {} against {} of point sampling", to_text(sixteen), to_text(hard)),
         judge_much_less(sixteen, hard),
         "Against the exact visibility over the same region.",
         {sixteen, hard}});
    const LightResult& light = light_of(timed);
    const Cell& narrow = printed_cell(light, 16);
    const Value cost = time_ratio(narrow, printed_cell(light, 1));
    context.report->claims.push_back(
        {"section 4.2, figure 7",
         "more samples make edges less noisy and cost more",
         fmt::format("error rms {}, {}, {} with 1, 4, 16 samples; 16 take {} times as long as 1", to_text(one),
                     to_text(four), to_text(sixteen), to_text(cost)),
         both(both(judge_less(four, one), judge_less(sixteen, four)), judge_less(exactly(1.0), cost)),
         "The numbers of samples of the figure, with its MinSamples of 1. The paper says \"better but more "
         "expensive\", and gives no size.",
         {one, four, sixteen, cost}});
    const Value wide = time_ratio(printed_cell(light, 16, 8), narrow),
                over_point = time_ratio(narrow, cell_of(light, "shadow_map"));
    context.report->claims.push_back(
        {"section 7",
         "a region needs only a constant number of samples, so the extra cost is bounded by a constant factor",
         fmt::format("16 samples over a region 8 times as wide take {} times as long; over the narrow one they take {} "
                     "times as long as point sampling",
                     to_text(wide), to_text(over_point)),
         judge_constant(wide),
         "Judged by the width of the region. The paper calls the factor over point sampling small, without a number. "
         "Here it is of lookups alone; table 1 has what they cost of an image.",
         {wide, over_point}});
}

// Lookups across the straight edge of an opaque half-plane at x = 64 of a map of 128 x 128 cells: columns of lookups at
// one distance from it.
constexpr int columns = 480, rows = 64;
constexpr double step = 0.125, first = 34.0 + 0.5 * step;  // cells

std::vector<float> across_edge(double res_factor, int samples, const char* placement, std::uint64_t repeat) {
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
        {"res_factor", res_factor}, {"num_samples", samples}, {"min_size", 0}, {"placement", placement}};
    base::Random random(base::hash(repeat, 8));
    const float up = static_cast<float>(random.uniform());
    std::vector<techniques::Query> queries;
    for (int x = 0; x < columns; ++x)
        for (int y = 0; y < rows; ++y)
            queries.push_back({static_cast<float>(first + step * x), 32.0f + up + static_cast<float>(y), 2.0f, 1.0f});
    return look_up("pcf", parameters, tile, 3.0f, queries);
}

struct Edge {
    double width;  // cells, from 10 to 90 % lit
    double place;  // cells, where it is half lit on average
    double noise;  // standard deviation over each column, rms over the columns that the region reaches
};

Edge edge(double res_factor, int samples, const char* placement, std::uint64_t repeat) {
    const std::vector<float> visibility = across_edge(res_factor, samples, placement, repeat);
    Edge found{0.0, 34.0 + step * columns, 0.0};
    double variances = 0.0, reached = 0.0;
    for (int x = 0; x < columns; ++x) {
        double mean = 0.0, squares = 0.0;
        for (int y = 0; y < rows; ++y) {
            const double value = visibility[static_cast<std::size_t>(x * rows + y)];
            mean += value / rows;
            squares += value * value;
        }
        if (mean > 0.1 && mean < 0.9) found.width += step;
        found.place -= step * mean;
        if (std::abs(first + step * x - 64.0) > 0.5 * res_factor) continue;
        variances += std::max(0.0, squares - rows * mean * mean) / (rows - 1.0);
        reached += 1.0;
    }
    found.noise = std::sqrt(variances / reached);
    return found;
}

struct Edges {
    Value width, place, noise;
};

// Over eight repeats: other positions along the edge, and so other random numbers.
Edges edges_of(double res_factor, int samples, const char* placement) {
    std::vector<double> widths, places, noises;
    for (std::uint64_t repeat = 0; repeat < 8; ++repeat) {
        const Edge found = edge(res_factor, samples, placement, repeat);
        widths.push_back(found.width);
        places.push_back(found.place);
        noises.push_back(found.noise);
    }
    return {mean_of(widths), mean_of(places), mean_of(noises)};
}

// The ways to place 16 samples in a region 8 cells wide.
void figure_3(PaperReport& report) {
    const Edges uniform = edges_of(8.0, 16, "uniform"), gaussian = edges_of(8.0, 16, "gaussian"),
                jittered = edges_of(8.0, 16, "jittered");
    report.claims.push_back(
        {"section 2, figure 3",
         "jittered samples make shadows less noisy than uniform or Gaussian ones",
         fmt::format("noise at a straight edge: {} jittered, {} uniform, {} Gaussian", to_text(jittered.noise),
                     to_text(uniform.noise), to_text(gaussian.noise)),
         both(judge_less(jittered.noise, uniform.noise), judge_less(jittered.noise, gaussian.noise)),
         "The standard deviation of the visibility at one distance from the edge, rms over the "
         "distances that the region reaches; 16 samples.",
         {jittered.noise, uniform.noise, gaussian.noise}});
    report.claims.push_back(
        {"section 2, figure 3",
         "images made with Gaussian samples do not appear substantially different from those made "
         "with uniform ones",
         fmt::format("edges are {} and {} cells wide (10 to 90 %), noise is {} and {}", to_text(gaussian.width),
                     to_text(uniform.width), to_text(gaussian.noise), to_text(uniform.noise)),
         not_comparable(),
         "The paper does not print the width of its Gaussian; here the region ends at two standard "
         "deviations.",
         {gaussian.width, uniform.width, gaussian.noise, uniform.noise}});
}

void figures_4_and_8(PaperReport& report) {
    constexpr double factors[] = {1, 3, 8};
    std::vector<Value> widths;
    Table table{
        "Figure 4: where a shadow's straight edge lies, in cells from its true place; means over eight places "
        "along the edge",
        {"ResFactor", "width (10 to 90 %)", "samples anywhere in their parts", "samples as printed"},
        {}};
    for (const double factor : factors) {
        const Edges spread = edges_of(factor, 64, "jittered"), published = edges_of(factor, 64, "published");
        widths.push_back(spread.width);
        const auto offset = [](const Edges& found) { return to_text(found.place - exactly(64.0)); };
        table.rows.push_back({fmt::format("{:g}", factor), to_text(spread.width), offset(spread), offset(published)});
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
        const std::vector<std::string> set{fmt::format("rays.resolution={}", resolution),
                                           fmt::format("receivers.filter_width={}", 4.0 * resolution / 1024.0),
                                           R"(techniques=[{"type":"pcf","num_samples":16,"res_factor":1}])"};
        std::vector<double> of_places;
        for (std::uint64_t place = 0; place < map_places; ++place)
            of_places.push_back(
                error_of(cell_of(light_of(context.run(sphere, moved(context, place, set), {})), "pcf")).value);
        errors.push_back(mean_of(of_places));
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
    figure_3(*context.report);
    figures_4_and_8(*context.report);
    figure_10(context);
}

}  // namespace shadowbench::claims::reeves
