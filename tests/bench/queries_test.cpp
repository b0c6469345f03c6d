#include "bench/queries.h"

#include <gtest/gtest.h>

#include <set>

#include "bench/half_covered.h"

namespace shadowbench::bench {
namespace {

using base::Vec3d;

TEST(ChooseJudged, takes_one_of_each_stretch) {
    const std::vector<std::size_t> chosen = choose_judged(1000, 7, 5);
    ASSERT_EQ(chosen.size(), 7u);
    for (std::size_t i = 0; i < 7; ++i) {
        EXPECT_GE(chosen[i], i * 1000 / 7);
        EXPECT_LT(chosen[i], (i + 1) * 1000 / 7);
    }
    EXPECT_EQ(chosen, choose_judged(1000, 7, 5));
    EXPECT_NE(chosen, choose_judged(1000, 7, 6));
}

TEST(ChooseJudged, takes_all_when_there_are_few) {
    EXPECT_EQ(choose_judged(3, 100, 5), (std::vector<std::size_t>{0, 1, 2}));
    EXPECT_TRUE(choose_judged(0, 100, 5).empty());
}

TEST(ProbeQueries, fill_the_map_and_reach_a_little_behind_the_casters) {
    const HalfCovered half = half_covered();
    scene::Receivers receivers;
    receivers.count = 5000;
    receivers.filter_width = 2.0;
    const QuerySet set = probe_queries(receivers, half.view);
    EXPECT_EQ(set.queries.size() + set.dropped, 5000u);
    EXPECT_EQ(set.dropped, 0u);
    float deepest = 0.0f;
    for (const techniques::Query& q : set.queries) {
        ASSERT_TRUE(q.x >= 0 && q.x < 8 && q.y >= 0 && q.y < 8 && q.z >= 1.0f && q.z <= 3.1f);
        ASSERT_EQ(q.width, 2.0f);
        deepest = std::max(deepest, q.z);
    }
    EXPECT_GT(deepest, 3.05f);
}

TEST(QueriesOfPoints, move_towards_the_light_and_drop_what_it_does_not_see) {
    const HalfCovered half = half_covered();
    scene::Receivers receivers;
    receivers.bias = 0.25;
    const std::vector<Vec3d> points{{0.0, -2.0, 0.0}, {5.0, -2.0, 0.0}, {-0.99, -1.0, 0.99}};
    const QuerySet set = queries_of_points(points, receivers, half.view);
    EXPECT_EQ(set.dropped, 1u);
    ASSERT_EQ(set.queries.size(), 2u);
    EXPECT_FLOAT_EQ(set.queries[0].x, 4.0f);
    EXPECT_FLOAT_EQ(set.queries[0].z, 1.75f);
    EXPECT_FLOAT_EQ(set.queries[1].z, 0.75f);
}

TEST(QueriesOfPoints, move_along_the_ray_in_perspective) {
    HalfCovered half = half_covered();
    half.view.perspective = true;  // lower and pixel are slopes now: 45 degrees at the map's edge
    half.view.z_near = 0.1;
    scene::Receivers receivers;
    receivers.bias = 0.5;
    const std::vector<Vec3d> points{{-1.9, -2.0, 0.0}, {0.0, -0.05, 0.0}, {0.0, 3.0, 0.0}};
    const QuerySet set = queries_of_points(points, receivers, half.view);
    EXPECT_EQ(set.dropped, 2u) << "before the near plane, and behind the light";
    ASSERT_EQ(set.queries.size(), 1u);
    EXPECT_NEAR(set.queries[0].z, 2.0 - 0.5 / std::sqrt(1.0 + 0.95 * 0.95), 1e-6);
}

TEST(CameraPoints, lie_on_the_nearest_surface_in_image_order) {
    const HalfCovered half = half_covered();
    scene::Receivers receivers;
    receivers.camera = scene::Camera{{0, 1, 0}, {0, -1, 0}, {0, 0, -1}, 20.0};
    receivers.resolution = {4, 2};
    const std::vector<Vec3d> points = camera_points(receivers, rays::Tracer(half.scene, false));
    ASSERT_EQ(points.size(), 8u);
    for (const Vec3d& p : points) EXPECT_NEAR(p.y, p.x < 0 ? -1.0 : -3.0, 1e-5);
    EXPECT_LT(points[0].x, points[1].x) << "left to right";
    EXPECT_LT(points[0].z, points[4].z) << "top row first: up is -z";
}

TEST(CameraPoints, spread_over_the_media_before_the_surface) {
    scene::Scene scene;
    scene::Particles puffs;  // on the view ray from 1 to 2, and from 3 to 6
    puffs.centres = {{0, -1.5f, 0}, {0, -4.5f, 0}};
    puffs.radii = {0.5f, 1.5f};
    puffs.density = {1.0f, 1.0f};
    scene.objects.push_back({"puffs", true, {1, 1, 1}, {1, 1, 1}, {0, 0, 0}, puffs});
    scene::Receivers receivers;
    receivers.camera = scene::Camera{{0, 0, 0}, {0, -1, 0}, {0, 0, -1}, 0.01};
    receivers.resolution = {1, 1};
    receivers.media_lookups = 4;
    const std::vector<Vec3d> points = camera_points(receivers, rays::Tracer(scene, false));
    ASSERT_EQ(points.size(), 4u) << "no surface behind them";
    const double depths[] = {1.5, 3.5, 4.5, 5.5};
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(points[i].y, -depths[i], 1e-3);
}

}  // namespace
}  // namespace shadowbench::bench
