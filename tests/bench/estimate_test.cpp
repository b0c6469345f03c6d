#include "bench/estimate.h"

#include <cstddef>

#include <gtest/gtest.h>

#include "bench/pace.h"

namespace shadowbench::bench {
namespace {

LightWork some_work() {
    LightWork work;
    work.pixels = 1e4;
    work.rays = 1.6e5;
    work.segments = 4.0;
    work.steps = 1.0;
    work.in_media = 4.0;
    work.fine = 1.0;
    work.exact = 4.0;
    work.truth_segments = 3.0;
    work.truth_rays = 1e6;
    work.truth_pixel_rays = 100.0;
    work.truth_samples = 100.0;
    work.receivers = 1e5;
    work.judged = 1000.0;
    work.footprint = 16.0;
    work.techniques = 2.0;
    work.traced = 1.0;
    work.lookup_rays = 16.0;
    work.compared = 20000.0;
    return work;
}

double seconds(const LightWork& work, const scene::Timing& timing = {}) {
    return estimate_seconds(work, timing, 2);
}

// Each part of the work that a term forgets would let jobs of hours through.
TEST(Estimate, grows_with_each_part_of_the_work) {
    const LightWork once = some_work();
    const double before = seconds(once);
    for (double LightWork::*part :
         {&LightWork::rays, &LightWork::segments, &LightWork::steps, &LightWork::exact, &LightWork::truth_segments,
          &LightWork::truth_rays, &LightWork::truth_samples, &LightWork::judged, &LightWork::footprint,
          &LightWork::techniques, &LightWork::fine, &LightWork::lookup_rays, &LightWork::compared,
          &LightWork::channels}) {
        LightWork twice = once;
        twice.*part *= 2.0;
        EXPECT_GT(seconds(twice), before);
        EXPECT_LE(seconds(twice), 2.0 * before * (1.0 + 1e-12)) << "no part is counted with its square";
    }
    LightWork more = once;
    more.spread_seeds = 4.0;
    EXPECT_GT(seconds(more), before);
    more = once;
    more.traced = 2.0;
    EXPECT_GT(seconds(more), before);
}

TEST(Estimate, is_linear_in_techniques_seeds_and_repetitions) {
    LightWork work = some_work();
    const auto with_techniques = [&](double count) {
        work.techniques = count;
        return seconds(work, {7, 7});
    };
    EXPECT_NEAR(with_techniques(9) - with_techniques(5), with_techniques(5) - with_techniques(1), 1e-9);
    work = some_work();
    const auto with_seeds = [&](double count) {
        work.spread_seeds = count;
        return seconds(work, {7, 7});
    };
    EXPECT_NEAR(with_seeds(8) - with_seeds(4), with_seeds(4) - with_seeds(0), 1e-9);
    work = some_work();
    const auto with_rounds = [&](int count) { return seconds(work, {count, count}); };
    EXPECT_NEAR(with_rounds(30) - with_rounds(20), with_rounds(20) - with_rounds(10), 1e-9);
    EXPECT_GT(with_rounds(20), with_rounds(10));
}

// Passes take some hundredths of a second, however many receivers there are.
TEST(Estimate, does_not_grow_with_lookups_beyond_a_pass) {
    LightWork work = some_work();
    scene::Timing timing;
    timing.lookups = 1 << 24;
    work.receivers = 1e6;
    const double many = seconds(work, timing);
    work.receivers = 1e7;
    EXPECT_DOUBLE_EQ(seconds(work, timing), many);
}

// 100,000 layers cost each ray of the truth once, not once for each query that it answers: estimates were seven times
// too long.
TEST(Estimate, counts_the_segments_of_a_ray_of_the_truth_once) {
    LightWork work = some_work();
    work.exact = 1e5;
    const double rays = 1000.0, few = gather_seconds(work, 10.0, 100.0, rays, 1.0);
    const double many = gather_seconds(work, 1000.0, 100.0, rays, 1.0);
    work.exact = 0.0;
    const double pairs = gather_seconds(work, 1000.0, 100.0, rays, 1.0) - gather_seconds(work, 10.0, 100.0, rays, 1.0);
    EXPECT_NEAR(many - few, pairs, 1e-6 * many) << "all rays were counted for ten queries";
    work.exact = 1e5;
    EXPECT_LT(gather_seconds(work, 1.0, 100.0, rays, 1.0), 0.2 * few) << "a tenth of the rays";
}

// Functions and means are made once for all techniques.
TEST(Estimate, counts_once_what_techniques_share) {
    LightWork work = some_work();
    const auto builds = [&](double techniques, bool shared) {
        work.techniques = techniques;
        work.shared = shared;
        return build_seconds(work);
    };
    const double once = builds(1, true) - builds(1, false);
    EXPECT_GT(once, 0.0);
    EXPECT_NEAR(builds(9, true) - builds(9, false), once, 1e-12);
}

// Builds of more than half a second are not repeated to warm the caches.
TEST(Estimate, makes_long_builds_once_a_round) {
    LightWork work = some_work();
    work.in_media = work.fine = 0.0;
    const auto of_a_build = [&](double segments) {
        work.segments = segments;
        const double build = build_seconds(work);
        const double seconds = estimate_seconds(work, {20, 20}, 2) - estimate_seconds(work, {10, 10}, 2);
        work.segments = 0.0;
        const double rest = estimate_seconds(work, {20, 20}, 2) - estimate_seconds(work, {10, 10}, 2);
        return (seconds - rest) / (build - build_seconds(work));
    };
    EXPECT_NEAR(of_a_build(4.0), 20.0, 1e-6) << "each of ten follows one that warms the caches";
    EXPECT_GT(of_a_build(1e4), 9.99);
    EXPECT_LT(of_a_build(1e4), 10.01);
}

TEST(Estimate, counts_bytes_of_files_primitives_and_view_rays) {
    EXPECT_EQ(estimate_reading(0), 0.0);
    EXPECT_NEAR(estimate_reading(3'000'000), 3.0 * estimate_reading(1'000'000), 1e-12);
    scene::Scenario scenario;
    scenario.lights.resize(1);
    scene::Spheres spheres{{{0, 0, 0}}, {1.0f}};
    const auto with_spheres = [&](std::size_t count) {
        scene::Object object;
        spheres.centres.resize(count);
        spheres.radii.resize(count, 1.0f);
        object.shape = spheres;
        scenario.scene.objects = {object};
        return estimate_preparing(scenario, 2);
    };
    const double without_camera = with_spheres(1000);
    EXPECT_NEAR(with_spheres(3000), 3.0 * without_camera, 1e-12);
    scenario.lights.resize(2);
    EXPECT_GT(with_spheres(1000), without_camera) << "each light has captures";
    scenario.lights.resize(1);
    scenario.receivers.camera = scene::Camera{{0, 0, 10}, {0, 0, 0}};
    const auto of_camera = [&](int side) {
        scenario.receivers.resolution = {side, side};
        return with_spheres(1000);
    };
    EXPECT_GT(of_camera(64), without_camera);
    EXPECT_NEAR(of_camera(256) - of_camera(128), 4.0 * (of_camera(128) - of_camera(64)), 1e-9);
}

TEST(Pace, is_that_of_a_machine) {
    const double pace = measure_pace();
    EXPECT_GE(pace, 0.1);
    EXPECT_LE(pace, 10.0);
}

}  // namespace
}  // namespace shadowbench::bench
