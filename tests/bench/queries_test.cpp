#include "bench/queries.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

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
    receivers.filter_width.value = 2.0;
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

TEST(PointQueries, keep_their_order_and_count_what_is_outside_the_map) {
    HalfCovered half = half_covered();
    scene::Receivers receivers;
    receivers.points = {{0.0, -2.0, 0.0}, {5.0, -2.0, 0.0}, {0.5, 3.0, -0.5}, {0.0, -2.0, 1.5}};
    receivers.bias = 0.25;
    receivers.filter_width.value = 3.0;
    const QuerySet set = point_queries(receivers, half.view);
    EXPECT_EQ(set.dropped, 2u);
    EXPECT_TRUE(set.footprints.empty()) << "a point has no pixel";
    ASSERT_EQ(set.queries.size(), 2u);
    EXPECT_FLOAT_EQ(set.queries[0].x, 4.0f);
    EXPECT_FLOAT_EQ(set.queries[0].z, 1.75f);
    EXPECT_FLOAT_EQ(set.queries[1].x, 6.0f);
    EXPECT_FLOAT_EQ(set.queries[1].z, -3.25f) << "behind where a directional light starts to count: still in its map";
    EXPECT_EQ(set.queries[1].width, 3.0f);

    half.view.perspective = true;
    half.view.z_near = 0.5;
    receivers.bias = 0.0;
    receivers.points = {{0, -0.5, 0}, {0, std::nextafter(-0.5, -1.0), 0}, {0, 0, 0}, {0, 2, 0}};
    const QuerySet near = point_queries(receivers, half.view);
    EXPECT_EQ(near.dropped, 3u) << "at the near plane, at the light, behind the light";
    ASSERT_EQ(near.queries.size(), 1u);
    EXPECT_FLOAT_EQ(near.queries[0].z, 0.5f);
}

TEST(QueriesOfPoints, move_towards_the_light_and_drop_points_that_it_does_not_see) {
    const HalfCovered half = half_covered();
    scene::Receivers receivers;
    receivers.bias = 0.25;
    const std::vector<CameraPoint> points{{{0.0, -2.0, 0.0}}, {{5.0, -2.0, 0.0}}, {{-0.99, -1.0, 0.99}}};
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
    const std::vector<CameraPoint> points{{{-1.9, -2.0, 0.0}}, {{0.0, -0.05, 0.0}}, {{0.0, 3.0, 0.0}}};
    const QuerySet set = queries_of_points(points, receivers, half.view);
    EXPECT_EQ(set.dropped, 2u) << "before the near plane, and behind the light";
    ASSERT_EQ(set.queries.size(), 1u);
    EXPECT_NEAR(set.queries[0].z, 2.0 - 0.5 / std::sqrt(1.0 + 0.95 * 0.95), 1e-6);
}

// A plane tilted about both axes, seen by the camera through 3 x 3 pixels.
QuerySet seen_on_a_tilted_plane(const rays::LightView& view) {
    scene::Mesh mesh;  // y = -2 + 0.4 x - 0.3 z
    for (const auto& [x, z] : {std::pair{-3.0f, -3.0f}, {3.0f, -3.0f}, {3.0f, 3.0f}, {-3.0f, 3.0f}})
        mesh.positions.push_back({x, -2.0f + 0.4f * x - 0.3f * z, z});
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene::Scene scene;
    scene.objects.emplace_back();
    scene.objects.back().shape = mesh;
    scene::Receivers receivers;
    receivers.camera = scene::Camera{{1.5, 1.0, 2.0}, {0.1, -2.0, 0.1}, {0, 0, -1}, 2.0};
    receivers.resolution = {3, 3};
    receivers.bias = 0.0;
    return queries_of_points(camera_points(receivers, rays::Tracer(scene, false)), receivers, view);
}

TEST(QueriesOfPoints, lay_the_pixel_of_a_tilted_plane_into_the_map_as_its_parallelogram) {
    for (const bool perspective : {false, true}) {
        HalfCovered half = half_covered();
        half.view.perspective = perspective;
        half.view.z_near = 0.1;
        const QuerySet set = seen_on_a_tilted_plane(half.view);
        ASSERT_EQ(set.queries.size(), 9u);
        ASSERT_EQ(set.footprints.size(), 9u);
        // The neighbours of the middle pixel are one edge away.
        const auto& q = set.queries;
        const techniques::Footprint& f = set.footprints[4];
        EXPECT_GT(std::abs(f.uy) + std::abs(f.vx), 0.001f) << "not along the axes";
        const float tolerance = 2e-3f * (std::abs(f.ux) + std::abs(f.vy));  // second order, and float positions
        EXPECT_NEAR(f.ux, (q[5].x - q[3].x) / 2, tolerance);
        EXPECT_NEAR(f.uy, (q[5].y - q[3].y) / 2, tolerance);
        EXPECT_NEAR(f.vx, (q[7].x - q[1].x) / 2, tolerance);
        EXPECT_NEAR(f.vy, (q[7].y - q[1].y) / 2, tolerance);
    }
}

TEST(QueriesOfPoints, project_edges_by_hand) {
    const HalfCovered half = half_covered();  // 4 map pixels a unit; map y is world -z
    const std::vector<CameraPoint> points{{{0.0, -2.0, 0.0}, {0.5, -7.0, 0.25}, {0.0, 3.0, -1.0}}};
    const QuerySet set = queries_of_points(points, {}, half.view);
    ASSERT_EQ(set.footprints.size(), 1u);
    EXPECT_FLOAT_EQ(set.footprints[0].ux, 2.0f);
    EXPECT_FLOAT_EQ(set.footprints[0].uy, -1.0f);
    EXPECT_FLOAT_EQ(set.footprints[0].vx, 0.0f);
    EXPECT_FLOAT_EQ(set.footprints[0].vy, 4.0f);
}

TEST(QueriesOfPoints, keep_footprints_beside_their_queries_when_some_are_dropped) {
    const HalfCovered half = half_covered();
    const std::vector<CameraPoint> points{{{5.0, -2.0, 0.0}, {9, 0, 0}, {0, 0, 9}},
                                          {{0.0, -2.0, 0.0}, {1, 0, 0}, {0, 0, 1}},
                                          {{0.5, -2.0, 0.0}, {2, 0, 0}, {0, 0, 2}}};
    const QuerySet set = queries_of_points(points, {}, half.view);
    ASSERT_EQ(set.queries.size(), 2u);
    ASSERT_EQ(set.footprints.size(), 2u);
    EXPECT_FLOAT_EQ(set.footprints[0].ux, 4.0f);
    EXPECT_FLOAT_EQ(set.footprints[1].ux, 8.0f);
    const std::size_t second[] = {1};
    const QuerySet picked = pick(set.asked(), second);
    EXPECT_EQ(picked.queries[0].x, set.queries[1].x);
    EXPECT_EQ(picked.footprints[0].ux, 8.0f);
}

}  // namespace
}  // namespace shadowbench::bench
