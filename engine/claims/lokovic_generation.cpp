// Lokovic and Veach, Deep Shadow Maps, 2000: the time to make maps, sections 4, 5.1 and 6.
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "bench/clock.h"
#include "claims/direct_sum.h"
#include "claims/first_light.h"
#include "claims/intervals.h"
#include "claims/lokovic.h"
#include "claims/lokovic_rows.h"
#include "claims/seeded_light.h"
#include "claims/turns.h"
#include "curves/composite.h"
#include "curves/sweep.h"
#include "rays/light_rays.h"

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
                             "Capture and build of both. The depth map has one sample a pixel. Both are timed one "
                             "after the other, and not in turn: this is the quotient of their medians, with the widest "
                             "interval that theirs allow.",
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
         "the sweep averages n functions in O(n log n)",
         fmt::format("building a map of 32 x 32 pixels takes (N log N)^{}; ms: {}", to_text(exponent), ms),
         judge_at_most_exponent(1.0, exponent),
         "O() is a bound. N samples a pixel are N functions. Sweep, compression and storing, on one thread; n^2 would "
         "be fitted as about 1.6. The interval is that of the fit (Student's t).",
         {exponent}});
}

// The transmittance functions of all rays of a map, the terms of its pixels' means.
class Terms {
public:
    explicit Terms(std::span<const rays::LightRays> tiles) {
        curves::OpenMedia open;
        std::vector<curves::Node> nodes;
        for (const rays::LightRays& tile : tiles) {
            samples_ = static_cast<std::size_t>(tile.samples);  // the same in all tiles
            for (std::size_t ray = 0; ray < tile.rays(); ++ray) {
                curves::composite(tile, ray, 0, open, nodes);
                curves::linearise(nodes, std::numeric_limits<double>::infinity(), functions_.emplace_back());
            }
        }
        for (const curves::Curve& function : functions_)
            terms_.push_back({function, 1.0 / static_cast<double>(samples_)});
    }
    Terms(const Terms&) = delete;  // terms_ refers to functions_
    Terms& operator=(const Terms&) = delete;

    // Milliseconds of calling sum() with the terms of each pixel.
    template <class Sum>
    double milliseconds(const Sum& sum) const {
        const std::span<const curves::WeightedCurve> all(terms_);
        const bench::Stopwatch stopwatch;
        for (std::size_t first = 0; first < all.size(); first += samples_) sum(all.subspan(first, samples_));
        return 1e3 * stopwatch.seconds();
    }

private:
    std::size_t samples_ = 1;
    std::vector<curves::Curve> functions_;
    std::vector<curves::WeightedCurve> terms_;
};

// The sweep's time over that of evaluating all functions at each vertex, of the same functions.
Value sweep_over_direct(const Context& context, int samples) {
    const nlohmann::json document = context.document(
        ball_scene,
        {fmt::format("rays.samples_per_pixel={}", samples), "rays.resolution=32", set_techniques(published_deep())});
    note_document(context, ball_scene, document);
    const Terms terms(FirstLight(document, context.data).tiles());
    curves::SweepScratch scratch;
    std::vector<float> depths;
    curves::Curve out;
    using Of = std::span<const curves::WeightedCurve>;
    const std::function<double()> works[] = {
        [&] { return terms.milliseconds([&](Of pixel) { curves::weighted_sum(pixel, scratch, out); }); },
        [&] { return terms.milliseconds([&](Of pixel) { direct_sum(pixel, depths, out); }); }};
    const Compared compared[] = {{0, 1}};
    return take_turns(works, compared, build_rounds).ratio(0, 1);
}

void sweep_against_direct(const Context& context) {
    std::vector<Judged> each;
    std::vector<Value> shares;
    std::string text;
    for (const int samples : {16, 64, 256}) {
        const Value share = sweep_over_direct(context, samples);
        each.push_back(judge_much_less(share, exactly(1.0)));
        shares.push_back(share);
        text += fmt::format("{}{} at N = {}", text.empty() ? "" : ", ", to_text(share), samples);
    }
    context.report->claims.push_back(
        {"section 5.1", "the sweep is much more efficient than computing the weighted averages directly",
         fmt::format("its time over that of evaluating all functions at each vertex: {}", text), in_all(each),
         "Judged at each N. Both average the same functions, of the rays of each pixel of a map of 32 x 32, on one "
         "thread: by the program's sweep of functions that are linear in pieces, and by sorting all vertices and "
         "evaluating every function on both sides of each.",
         shares});
}

}  // namespace

void generation(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    compare_with_depth_maps(context);
    sweep_law(context);
    sweep_against_direct(context);
}

}  // namespace shadowbench::claims::lokovic
