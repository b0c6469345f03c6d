// Reeves, Salesin, Cook 1987: figures 3 and 8, and the jitter that figure 4 prints, at the straight edge of a
// half-plane.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "claims/hand_made.h"
#include "claims/intervals.h"
#include "claims/profile.h"
#include "claims/reeves.h"

namespace shadowbench::claims::reeves {
namespace {

// Lookups across the straight edge of an opaque half-plane at x = 64 of a map of 128 x 128 cells: columns of lookups at
// one distance from it.
constexpr int columns = 480, rows = 64;
constexpr double step = 0.125, first = 34.0 + 0.5 * step;  // cells

// Regions are res_factor times `width` cells wide.
struct Filter {
    double res_factor;
    int samples;
    const char* placement;
    double width = 1.0;

    double region() const { return res_factor * width; }
};

std::vector<float> across_edge(const Filter& filter, std::uint64_t repeat) {
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
    const nlohmann::json parameters = {{"res_factor", filter.res_factor},
                                       {"num_samples", filter.samples},
                                       {"min_size", 0},
                                       {"placement", filter.placement}};
    base::Random random(base::hash(repeat, 8));
    const float up = static_cast<float>(random.uniform());
    std::vector<techniques::Query> queries;
    for (int x = 0; x < columns; ++x)
        for (int y = 0; y < rows; ++y)
            queries.push_back({static_cast<float>(first + step * x), 32.0f + up + static_cast<float>(y), 2.0f,
                               static_cast<float>(filter.width)});
    return look_up("pcf", parameters, tile, 3.0f, queries);
}

struct Edge {
    double width;  // cells, from 10 to 90 % lit
    double place;  // cells, where it is half lit on average
    double noise;  // standard deviation over each column, rms over the columns that the region reaches
    double error;  // rms over all columns, from the exact mean over the region
};

Edge edge(const Filter& filter, std::uint64_t repeat) {
    const std::vector<float> visibility = across_edge(filter, repeat);
    Edge found{0.0, 34.0 + step * columns, 0.0, 0.0};
    std::vector<double> means;
    double variances = 0.0, reached = 0.0, errors = 0.0;
    for (int x = 0; x < columns; ++x) {
        const double off_edge = first + step * x - 64.0;
        const double exact = std::clamp(0.5 + off_edge / filter.region(), 0.0, 1.0);
        double mean = 0.0, squares = 0.0;
        for (int y = 0; y < rows; ++y) {
            const double value = visibility[static_cast<std::size_t>(x * rows + y)];
            mean += value / rows;
            squares += value * value;
            errors += (value - exact) * (value - exact);
        }
        means.push_back(mean);
        found.place -= step * mean;
        if (std::abs(off_edge) > 0.5 * filter.region()) continue;
        variances += std::max(0.0, squares - rows * mean * mean) / (rows - 1.0);
        reached += 1.0;
    }
    found.width = step * (first_reached(means, 0.9) - first_reached(means, 0.1));
    found.noise = std::sqrt(variances / reached);
    found.error = std::sqrt(errors / (columns * rows));
    return found;
}

struct Edges {
    Value width, place, noise, error;
};

// Over eight repeats: other positions along the edge, and so other random numbers.
Edges edges_of(const Filter& filter) {
    std::vector<double> widths, places, noises, errors;
    for (std::uint64_t repeat = 0; repeat < 8; ++repeat) {
        const Edge found = edge(filter, repeat);
        widths.push_back(found.width);
        places.push_back(found.place);
        noises.push_back(found.noise);
        errors.push_back(found.error);
    }
    return {mean_of(widths), mean_of(places), mean_of(noises), mean_of(errors)};
}

// The ways to place 16 samples in a region 8 cells wide.
void figure_3(PaperReport& report) {
    const Edges uniform = edges_of({8.0, 16, "uniform"}), gaussian = edges_of({8.0, 16, "gaussian"}),
                jittered = edges_of({8.0, 16, "jittered"});
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
        const Edges spread = edges_of({factor, 64, "jittered"}), published = edges_of({factor, 64, "published"});
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

// In regions that are 4 cells wide with ResFactor 1, so that 16 samples lie in each.
void quantisation(PaperReport& report) {
    const auto error = [](double factor, int samples) { return edges_of({factor, samples, "jittered", 4.0}).error; };
    const Value one = error(1.0, 16), three = error(3.0, 16), eight = error(8.0, 16), more = error(8.0, 64);
    report.claims.push_back(
        {"section 4.2, figure 8",
         "a large ResFactor makes the quantization of the shadow intensity more apparent, unless NumSamples is "
         "increased",
         fmt::format("error rms over a strip 60 cells wide: {}, {}, {} with ResFactor 1, 3, 8 and 16 samples, {} with "
                     "ResFactor 8 and 64 samples",
                     to_text(one), to_text(three), to_text(eight), to_text(more)),
         both(both(judge_less(one, three), judge_less(three, eight)), judge_less(more, eight)),
         "Off the exact mean over the region. A sample is one step of the intensity; a wider edge has the same steps "
         "over more of the picture.",
         {one, three, eight, more}});
}

}  // namespace

void half_plane(const Context& context) {
    figure_3(*context.report);
    figures_4_and_8(*context.report);
    quantisation(*context.report);
}

}  // namespace shadowbench::claims::reeves
