#include "bench/estimate.h"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bench/pace.h"

namespace shadowbench::bench {
namespace {

LightWork some_work() {
    LightWork work;
    work.pixels = 1e4;
    work.rays = 1.6e5;
    work.segments = 4.0;
    work.truth_rays = 1e6;
    work.truth_pixel_rays = 100.0;
    work.truth_samples = 100.0;
    work.receivers = 1e5;
    work.judged = 1000.0;
    work.footprint = 16.0;
    work.techniques = 2.0;
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
         {&LightWork::rays, &LightWork::segments, &LightWork::truth_rays, &LightWork::truth_samples, &LightWork::judged,
          &LightWork::footprint, &LightWork::techniques, &LightWork::channels}) {
        LightWork twice = once;
        twice.*part *= 2.0;
        EXPECT_GT(seconds(twice), before);
        EXPECT_LE(seconds(twice), 2.0 * before * (1.0 + 1e-12)) << "no part is counted with its square";
    }
    LightWork more = once;
    more.spread_seeds = 4.0;
    EXPECT_GT(seconds(more), before);
    more = once;
    more.traced = 1.0;
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

// 0.09 s were estimated for a job whose pictures took 10.5 s.
TEST(Estimate, counts_pictures_by_their_pixels_lights_and_techniques) {
    scene::Scenario scenario;
    scenario.receivers.camera = scene::Camera{{0, 0, 10}, {0, 0, 0}};
    scene::Object ball;
    ball.shape = scene::Spheres{{{0, 0, 0}}, {1.0f}};
    scenario.scene.objects.push_back(ball);
    LightWork work = some_work();
    const auto of = [&](int side, std::size_t lights) {
        scenario.receivers.resolution = {side, side};
        return estimate_pictures(scenario, std::vector<LightWork>(lights, work), 2);
    };
    EXPECT_NEAR(of(2048, 1) - of(1024, 1), 4.0 * (of(1024, 1) - of(512, 1)), 1e-6 * of(2048, 1));
    EXPECT_NEAR(of(512, 3) - of(512, 2), of(512, 2) - of(512, 1), 1e-9);
    const double two = of(512, 1);
    work.techniques = 4.0;
    EXPECT_GT(of(512, 1), 1.2 * two);
    EXPECT_EQ(of(512, 0), 0.0);
}

scene::Scene one(scene::Object object) {
    scene::Scene scene;
    scene.objects.push_back(std::move(object));
    return scene;
}

// Orthographic, along z, of 10 by 10 lengths and 100 by 100 pixels around the origin.
rays::LightView square_view() {
    rays::LightView view;
    view.lower = {-5.0, -5.0};
    view.pixel = {0.1, 0.1};
    view.resolution = {100, 100};
    return view;
}

TEST(ExpectedHits, are_the_projected_areas_over_that_of_the_map) {
    scene::Object object;
    scene::Mesh triangle;
    triangle.positions = {{0, 0, 1}, {2, 0, 1}, {0, 2, 3}};
    triangle.triangles = {{0, 1, 2}};
    object.shape = triangle;
    EXPECT_NEAR(expected_hits(one(object), square_view(), true, false).segments, 0.02, 1e-9);
    object.shape = scene::Spheres{{{1, 1, 1}, {-2, 0, 5}}, {1.0f, 1.0f}};
    EXPECT_NEAR(expected_hits(one(object), square_view(), true, false).segments, 4.0 * 0.0314159265, 1e-6);
    object.shape = scene::Spheres{{{5, 0, 1}}, {1.0f}};
    EXPECT_NEAR(expected_hits(one(object), square_view(), true, false).segments, 0.0314159265, 1e-6)
        << "half is outside";
    object.casts_shadow = false;
    EXPECT_EQ(expected_hits(one(object), square_view(), true, false).segments, 0.0);
    EXPECT_GT(expected_hits(one(object), square_view(), false, false).segments, 0.0);
}

// What lies behind an opaque layer is captured, but no camera sees it.
TEST(ExpectedHits, ends_what_is_seen_where_it_is_dark) {
    scene::Mesh mesh;
    mesh.positions = {{-5, -5, 1}, {5, -5, 1}, {5, 5, 1}, {-5, 5, 1}};
    for (int layer = 0; layer < 50; ++layer)
        for (const base::Vec3i& half : {base::Vec3i{0, 1, 2}, base::Vec3i{0, 2, 3}}) mesh.triangles.push_back(half);
    scene::Object object;
    object.shape = mesh;
    const auto seen = [&](float opacity) {
        object.opacity = {opacity, opacity, opacity};
        const ExpectedHits hits = expected_hits(one(object), square_view(), false, false);
        EXPECT_NEAR(hits.segments, 50.0, 1e-6);
        return hits.seen;
    };
    EXPECT_NEAR(seen(1.0f), 1.0, 1e-6);
    EXPECT_NEAR(seen(0.5f), 14.0, 1e-6) << "0.5^14 is the first power below 1e-4";
    EXPECT_NEAR(seen(0.0f), 50.0, 1e-6);
}

TEST(Pace, is_that_of_a_machine) {
    const double pace = measure_pace();
    EXPECT_GE(pace, 0.1);
    EXPECT_LE(pace, 10.0);
}

}  // namespace
}  // namespace shadowbench::bench
