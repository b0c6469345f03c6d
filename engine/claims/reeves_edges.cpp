// Reeves, Salesin, Cook 1987: figures 6, 7 and 10, and values of ResFactor below one.
#include <string>
#include <vector>

#include <fmt/format.h>

#include "claims/intervals.h"
#include "claims/reeves.h"

namespace shadowbench::claims::reeves {
namespace {

using results::Cell;
using results::LightResult;

// MinSize and MinSamples as figure 4 prints them, so that a single sample is possible as in figure 7.
std::string printed(int samples, int res_factor = 1) {
    return fmt::format(R"({{"type":"pcf","num_samples":{},"res_factor":{},"min_size":0,"min_samples":1}})", samples,
                       res_factor);
}

const Cell& printed_cell(const LightResult& light, int samples, int res_factor = 1) {
    return cell_of(light, "pcf", {fmt::format("num_samples={}", samples), fmt::format("res_factor={}", res_factor)});
}

// With ResFactor below 1, which the technique refuses: a region of this width, in cells, where the footprint has 8.
std::string narrower(int width) {
    return fmt::format(R"({{"type":"pcf","num_samples":16,"res_factor":1,"min_size":0,"min_samples":1,"region":{}}})",
                       width);
}

// The errors of point sampling, of regions with 1, 4 and 16 samples, and of regions of a half and a quarter of the
// width.
struct Errors {
    std::vector<double> hard, one, four, sixteen, half, quarter;  // [place]

    void add(const LightResult& light) {
        hard.push_back(error_of(cell_of(light, "shadow_map")).value);
        one.push_back(error_of(printed_cell(light, 1)).value);
        four.push_back(error_of(printed_cell(light, 4)).value);
        sixteen.push_back(error_of(printed_cell(light, 16)).value);
        half.push_back(error_of(cell_of(light, "pcf", {"region=4"})).value);
        quarter.push_back(error_of(cell_of(light, "pcf", {"region=2"})).value);
    }
};

void figures_6_and_7(const Context& context) {
    const std::vector<std::string> set{fmt::format(R"(techniques=[{{"type":"shadow_map"}},{},{},{},{},{},{}])",
                                                   printed(1), printed(4), printed(16), printed(16, 8), narrower(4),
                                                   narrower(2))};
    const results::Result timed = context.run(sphere, moved(context, sphere, 0, set), {}, Times::taken);
    Errors errors;
    errors.add(light_of(timed));
    for (std::uint64_t place = 1; place < map_places; ++place)
        errors.add(light_of(context.run(sphere, moved(context, sphere, place, set), {})));
    const Value hard = mean_of(errors.hard), one = mean_of(errors.one), four = mean_of(errors.four),
                sixteen = mean_of(errors.sixteen), half = mean_of(errors.half), quarter = mean_of(errors.quarter);
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
         "Judged by the width of the region. The factor over point sampling is of lookups alone here; that of an image "
         "has a claim of its own.",
         {wide, over_point}});
    context.report->claims.push_back(
        {"section 4.2",
         "ResFactor should never be less than one: then aliases of the depth map are reproduced in the shadows",
         fmt::format("error rms {} with ResFactor 1, {} with 0.5, {} with 0.25; {} of point sampling", to_text(sixteen),
                     to_text(half), to_text(quarter), to_text(hard)),
         both(judge_less(sixteen, half), judge_less(half, quarter)),
         "Against the exact visibility over the region of ResFactor 1. Narrower regions come nearer to point sampling, "
         "which has all aliases.",
         {sixteen, half, quarter, hard}});
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
                error_of(cell_of(light_of(context.run(sphere, moved(context, sphere, place, set), {})), "pcf")).value);
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
    figure_10(context);
}

}  // namespace shadowbench::claims::reeves
