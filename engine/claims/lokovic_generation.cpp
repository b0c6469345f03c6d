// Lokovic and Veach, Deep Shadow Maps, 2000: the time to make maps, sections 4, 5.1 and 6.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"
#include "claims/intervals.h"
#include "claims/lokovic.h"
#include "claims/lokovic_rows.h"
#include "claims/seeded_light.h"

namespace shadowbench::claims::lokovic {
namespace {

constexpr std::size_t deep_map = 0, depth_map = 1;  // the places of a row's maps among the turns of builds
constexpr int many_samples = 144;  // of figure 7's rows the last that is captured often in a minute, on one thread

// Of a row of figure 7, on one thread.
struct Generated {
    Turns ms;
    std::size_t capture;

    // Capture and build of one of the maps.
    std::vector<double> all_of(std::size_t map) const {
        std::vector<double> sums = ms.times[map];
        for (std::size_t round = 0; round < sums.size(); ++round) sums[round] += ms.times[capture][round];
        return sums;
    }
};

Generated generate(const Context& context, int samples) {
    const SeededLight light(context, ball_scene, settings_of_row(samples), smaller_row());
    const std::size_t capture = light.capture_place();
    const Compared compared[] = {{deep_map, capture}};
    return {light.build_turns(compared), capture};
}

void compare_with_depth_maps(const Context& context) {
    PaperReport& report = *context.report;
    const Generated many = generate(context, many_samples), one = generate(context, 1);
    const std::vector<double> deep = many.all_of(deep_map);
    const Value equal = ratio_of(deep, many.all_of(depth_map)), added = equal - exactly(1.0),
                share = ratio_of(many.ms.times[deep_map], deep);
    report.claims.push_back(
        {"section 6, figure 7",
         "the compression overhead of deep maps is negligible in the time to generate a shadow map",
         fmt::format(
             "at N = {} a deep map takes {} of the depth map's time more; sweep, compression and storing are {} "
             "of its own time (one thread)",
             many_samples, to_text(added), to_text(share)),
         in_readings({judge_negligible(added), judge_negligible(share)}),
         "The sentence is about generation times. Judged in two readings: what a deep map takes beyond a depth map of "
         "as many samples, and the share of its own time after the capture, which also holds the sweep. Here the "
         "capture is a projection many times faster than the scanline renderer of the paper.",
         {added, share}});
    const Value of_plain = median_of(deep) / median_of(one.all_of(depth_map));
    report.claims.push_back({"section 4, and section 6, figure 7",
                             "a deep map takes about as long to generate as a depth map of as many samples",
                             fmt::format("{} times as long at N = {} (one thread)", to_text(equal), many_samples),
                             judge_ratio(1.0, equal),
                             "Capture and build of both. The paper's times were similar and are not shown.",
                             {equal}});
    report.claims.push_back({"section 4",
                             "a deep map is significantly more expensive to compute than a depth map of as many pixels",
                             fmt::format("{} times as long at N = {} (one thread)", to_text(of_plain), many_samples),
                             judge_significant(exactly(1.0), of_plain),
                             "Capture and build of both. The depth map has one sample a pixel.",
                             {of_plain}});
}

// A smaller map, whose pixels hold more hairs: then the rays of many samples are captured in a second.
void sweep_law(const Context& context) {
    std::vector<std::pair<double, double>> points;
    std::string ms;
    for (const int samples : {16, 64, 144, 256, 576, 1024}) {
        const SeededLight light(
            context, ball_scene,
            {fmt::format("rays.samples_per_pixel={}", samples), "rays.resolution=32", set_techniques(published_deep())},
            {});
        const Value build = light.build_turns({}).time(0);
        points.emplace_back(samples * std::log2(samples), build.value);
        ms += fmt::format("{}{} at N = {}", ms.empty() ? "" : ", ", to_text(build), samples);
    }
    const Value exponent = fitted_exponent(points);
    context.report->claims.push_back(
        {"section 5.1",
         "the sweep averages n functions in O(n log n), where evaluating all of them at each vertex takes O(n^2)",
         fmt::format("building a map of 32 x 32 pixels takes (N log N)^{}; ms: {}", to_text(exponent), ms),
         judge_at_most_exponent(1.0, exponent),
         "O() is a bound. N samples a pixel are N functions. Sweep, compression and storing, on one thread; n^2 would "
         "be fitted as about 1.6. The interval is that of the fit (Student's t).",
         {exponent}});
}

}  // namespace

void generation(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    compare_with_depth_maps(context);
    sweep_law(context);
}

}  // namespace shadowbench::claims::lokovic
