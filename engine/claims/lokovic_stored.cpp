// Lokovic and Veach, Deep Shadow Maps, 2000: sections 5.2 and 5.5.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"
#include "claims/answers_over_seeds.h"
#include "claims/intervals.h"
#include "claims/lokovic.h"
#include "claims/lokovic_filtering.h"
#include "claims/seeded_light.h"

namespace shadowbench::claims::lokovic {
using results::Cell;

void channels(const Context& context) {
    PaperReport& report = *context.report;
    const std::string deep = set_techniques(pixels + ("," + published_deep("pixels"))),
                      seeds = "reference.spread_seeds=2";
    const results::Result grey = context.run(hair_ball, {deep}, {"rays.resolution=128"});
    const results::Result colour =
        context.run(hair_ball, {"/scene/objects/0/opacity=[0.9,0.6,0.35]", seeds, deep}, {"rays.resolution=128"});
    const results::Result one_channel =
        context.run(hair_ball, {"/scene/objects/0/opacity=0.6", seeds, deep}, {"rays.resolution=128"});
    const auto three_over_one = [&](const char* compression) {
        const auto bytes = [&](const results::Result& result) {
            return bytes_of(cell_of(light_of(result), "deep", {fmt::format("compression={}", compression)}));
        };
        return bytes(colour) / bytes(one_channel);
    };
    const Value published = three_over_one("published"), bounded = three_over_one("bounded");
    report.claims.push_back({"section 5.2",
                             "three-channel maps are only twice as large as one-channel maps",
                             fmt::format("{} times with the paper's compression, {} times with the program's default",
                                         to_text(published), to_text(bounded)),
                             in_readings({judge_size(2.0, 3.0, published), judge_size(2.0, 3.0, bounded)}),
                             "Hair of opacity (0.9, 0.6, 0.35) against hair of opacity 0.6 in one channel.",
                             {published, bounded}});
    const bool grey_is_one = light_of(grey).layout.channels == 1;
    report.claims.push_back(
        {"section 5.2",
         "monochrome maps store one channel",
         grey_is_one ? "a grey scene makes a map of one channel" : "a grey scene makes three channels",
         by_construction(grey_is_one),
         "This holds for single pixels too: if the three functions are equal, one is kept.",
         {}});
}

namespace {

constexpr const char* motion_scene = "lokovic2000_motion";

SeededLight moving_light(const Context& context, int samples) {
    return {context,
            motion_scene,
            {fmt::format("rays.samples_per_pixel={}", samples), "rays.resolution=128",
             set_techniques(R"({"type":"deep","tolerance":0})")},
            {"rays.resolution=64"}};
}

// The errors of a map without compression at the middles of its pixels, where a lookup reads one function.
void stationary_receivers(const Context& context) {
    constexpr int numbers[] = {4, 16, 64, 256};
    const SeededLight first = moving_light(context, numbers[0]);
    const bench::QuerySet image = first.queries();  // the same for all numbers of samples, as the truth
    std::vector<techniques::Query> middles;
    for (const std::size_t i : bench::choose_judged(image.queries.size(), 8192, 1)) {
        const techniques::Query& q = image.queries[i];
        middles.push_back({std::floor(q.x) + 0.5f, std::floor(q.y) + 0.5f, q.z, 1.0f});
    }
    const bench::Truth truth = first.truth(middles);
    std::vector<std::pair<double, double>> points;
    std::vector<Value> values;
    std::string text;
    for (const int samples : numbers) {
        const SeededLight light = moving_light(context, samples);
        AnswersOverSeeds answers(truth);
        for (int seed = 0; seed < ray_seeds; ++seed) answers.add(bench::lookup_all(light.build(seed).front(), middles));
        values.push_back(answers.rms());
        points.emplace_back(samples, values.back().value);
        text += fmt::format("{}{} at N = {}", text.empty() ? "" : ", ", to_text(values.back()), samples);
    }
    const Value exponent = fitted_exponent(points);
    values.push_back(exponent);
    context.report->claims.push_back(
        {"section 5.5",
         "motion-blurred shadows are strictly correct when the receiver is stationary with respect to the shadow "
         "camera",
         fmt::format("error rms without compression, at the middles of pixels: {}: as N^{}", text, to_text(exponent)),
         judge_at_most_exponent(-0.5, exponent),
         "What is correct has no error but noise, which falls at least as section 2 says: O(N^(-1/2)). The interval is "
         "that of the fit (Student's t). Receivers are fixed points here: what moving ones would see is not measured.",
         std::move(values)});
}

}  // namespace

void motion(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    PaperReport& report = *context.report;
    const std::vector<std::string> no_motion{"/scene/objects/0/motion=[0,0,0]"}, smaller{"rays.resolution=96"};
    std::vector<std::string> still_set = no_motion, moving_set{"reference.spread_seeds=2"};
    still_set.insert(still_set.end(), moving_set.begin(), moving_set.end());
    const results::Result moving = context.run(motion_scene, moving_set, smaller),
                          still = context.run(motion_scene, still_set, smaller);
    const Cell &a = cell_of(light_of(moving), "deep"), &b = cell_of(light_of(still), "deep");
    TimedMaps timed;
    timed.add(context, motion_scene, {set_techniques(pixels + ("," + pcf(64, "sample")))}, smaller, 16384);
    timed.add(context, motion_scene, no_motion, smaller, 16384);
    enum { blurred, blurred_depths, unblurred };  // the places of the maps
    const Compared compared[] = {{blurred, unblurred}, {blurred, blurred_depths}};
    const Turns ns = timed.take(compared);
    const Value cost = ns.ratio(blurred, unblurred), of_depths = ns.ratio(blurred, blurred_depths),
                size = bytes_of(a) / bytes_of(b);
    report.claims.push_back(
        {"section 6, figure 12",
         "motion blur costs no more at lookup",
         fmt::format("{} times the time of the still sphere, and {} times its bytes", to_text(cost), to_text(size)),
         judge_constant(cost),
         "A blurred pixel stores a function of more steps, and is searched in the same way.",
         {cost, size}});
    report.claims.push_back(
        {"section 5.5",
         "with depth maps motion blur is very expensive, because of the large filters that it needs, much of which "
         "deep maps do in advance",
         fmt::format("a deep lookup takes {} of the time of filtering a depth map", to_text(of_depths)),
         judge_much_less(of_depths, exactly(1.0)),
         "Of a pixel with 64 samples, each with a time of its own: a depth map compares all of them, in a region 8 of "
         "its cells wide, to have the noise of the deep map's one function.",
         {of_depths}});
    stationary_receivers(context);
}

}  // namespace shadowbench::claims::lokovic
