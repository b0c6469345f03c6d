#include "bench/work.h"

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/contender.h"
#include "bench/load.h"
#include "bench/seen_places.h"
#include "document/document.h"
#include "rays/capture.h"
#include "rays/light_view.h"
#include "temporary_folder.h"

namespace shadowbench::bench {
namespace {

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

// The work of a light with a map of 100 by 100 pixels and 16 rays a pixel, above a square of the same size.
class CountedWork : public ::testing::Test {
protected:
    CountedWork() {
        scene::Mesh square;
        square.positions = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
        square.triangles = {{0, 1, 2}, {0, 2, 3}};
        scene::Object object;
        object.shape = square;
        scenario_.scene = one(object);
        scenario_.lights.resize(1);
        scenario_.lights[0].direction = {0, 0, -1};
        scenario_.lights[0].extent = base::Vec2d(10, 10);
        scenario_.rays.resolution = {100, 100};
        scenario_.reference.samples_per_pixel = 64;
    }
    struct Asked {
        std::string type, parameters = "{}";
    };
    LightWork count(const std::vector<Asked>& techniques = {}) const {
        const rays::LightView view =
            rays::make_light_view(scenario_.lights[0], scenario_.scene, scenario_.rays.resolution, "");
        std::vector<Contender> contenders;
        for (const Asked& technique : techniques)
            contenders.push_back(make_contender({technique.type, technique.parameters, ""}, ""));
        return count_work(scenario_, 0, rays::make_layout(scenario_.scene, view, scenario_.rays), view, contenders);
    }

    scene::Scenario scenario_;
};

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

// The way from the end of one strand to the start of the next is no hair: a ball of short hair was counted seven times.
TEST(ExpectedHits, leave_out_what_joins_strands) {
    scene::Object object;
    object.shape = scene::Hair{{{-2, 0, 1}, {-1, 0, 1}, {4, 4, 1}, {4, 3, 1}}, {0.1f, 0.1f, 0.1f, 0.1f}, {0, 2, 4}};
    EXPECT_NEAR(expected_hits(one(object), square_view(), false, false).segments, 2.0 * 0.2 / 100.0, 1e-8);
}

// A map of 1 by 4096 pixels was estimated to have seven times the hair that it has.
TEST(ExpectedHits, of_hair_do_not_depend_on_the_shape_of_the_pixels) {
    scene::Object object;
    object.shape = scene::Hair{{{-2, 0, 1}, {-1, 0, 1}}, {0.1f, 0.1f}, {0, 2}};
    rays::LightView view = square_view();
    view.pixel = {10.0, 0.01};
    view.resolution = {1, 1000};
    EXPECT_NEAR(expected_hits(one(object), view, false, false).segments, 0.2 / 100.0, 1e-4);
}

// Pictures widen hair: a ball of it took ten times as long as estimated.
TEST(ExpectedHits, of_widened_hair_are_more_and_reach_deeper) {
    scene::Hair hair;
    for (int strand = 0; strand < 10000; ++strand) {
        hair.strand_begin.push_back(static_cast<std::uint32_t>(hair.points.size()));
        for (const float x : {-5.0f, 5.0f}) {
            hair.points.push_back({x, -5.0f + 0.001f * static_cast<float>(strand), 1.0f});
            hair.radii.push_back(0.005f);
        }
    }
    hair.strand_begin.push_back(static_cast<std::uint32_t>(hair.points.size()));
    scene::Object object;
    object.shape = hair;
    const ExpectedHits thin = expected_hits(one(object), square_view(), false, false);
    const ExpectedHits wide = expected_hits(object, square_view(), false, 0.5);
    EXPECT_NEAR(thin.segments, 10.0, 0.02);
    EXPECT_NEAR(wide.segments, 50.0, 0.5) << "half a pixel of 0.1 is five times as wide";
    EXPECT_NEAR(thin.seen, 1.0, 0.01);
    EXPECT_NEAR(wide.seen, 42.0, 0.5) << "0.8^42 is the first power below 1e-4";
}

// A tracer tests the pieces whose boxes a ray enters: long ones the more.
TEST(ExpectedHits, count_tests_of_hair_by_its_length) {
    scene::Object object;
    object.shape = scene::Hair{{{-1, 0, 1}, {1, 0, 1}}, {0.1f, 0.1f}, {0, 2}};
    EXPECT_NEAR(expected_hits(one(object), square_view(), false, false).hair_tests, 2.0 * (0.2 + 2.0 * 0.5) / 100.0,
                1e-7);
}

// A grid of a voxel is captured in steps, but traced, and in the truth, as one cell: a million steps were estimated to
// take minutes to look up.
TEST_F(CountedWork, of_grids_is_of_steps_for_maps_and_of_cells_for_traced_rays) {
    scene::GridVolume grid;
    grid.size = {1, 1, 1};
    grid.density = {1};
    grid.lower = {-5, -5, -12};
    grid.upper = {5, 5, -2};
    grid.step = 0.01;
    scene::Object object;
    object.shape = grid;
    scenario_.scene.objects.push_back(object);
    const LightWork work = count({{"deep"}, {"deep", R"({"tolerance": 0})"}});
    EXPECT_NEAR(work.steps, 1000.0, 1e-6);
    EXPECT_NEAR(work.in_media, 1001.0, 1e-6) << "the pixels of the square hold media too";
    EXPECT_EQ(work.fine, 1.0);
    EXPECT_NEAR(work.segments, 1001.0, 1e-6);
    EXPECT_NEAR(work.exact, 1.0 + 2.0, 1e-6);
    EXPECT_NEAR(work.truth_segments, 1.0, 1e-6) << "captured; the grid is marched";
}

// Pictures look up points along the way of a view ray through media.
TEST(ExpectedHits, know_the_way_through_media) {
    scene::Object object;
    object.shape = scene::Particles{{{0, 0, 1}, {2, 2, 5}}, {1.0f, 0.5f}, {1.0f, 1.0f}};
    ExpectedHits hits = expected_hits(one(object), square_view(), false, false);
    EXPECT_NEAR(hits.inside, 4.18879 * (1.0 + 0.125) / 100.0, 1e-5) << "their volume over the area of the map";
    EXPECT_NEAR(hits.steps, 3.14159265 * 1.25 / 100.0, 1e-6);
    object.shape = scene::Particles{std::vector<base::Vec3f>(50, {0, 0, 1}), std::vector<float>(50, 1.0f),
                                    std::vector<float>(50, 1e-6f)};
    EXPECT_LT(expected_hits(one(object), square_view(), false, false).inside, 0.09) << "fifty in one place are one way";
    scene::GridVolume grid;
    grid.size = {2, 2, 2};
    grid.density = {1, 0, 1, 0, 1, 0, 1, 0};
    grid.lower = {-1, -1, 1};
    grid.upper = {1, 1, 3};
    grid.step = 0.1;
    object.shape = grid;
    hits = expected_hits(one(object), square_view(), false, false);
    EXPECT_NEAR(hits.inside, 0.5 * 8.0 / 100.0, 1e-6) << "half of it is empty";
    EXPECT_NEAR(hits.steps, 0.04 * 0.5 * 20.0, 1e-6);
    EXPECT_NEAR(hits.grids, hits.steps, 1e-9);
    EXPECT_NEAR(expected_hits(one(object), square_view(), false, true).steps, 0.04 * 0.5 * 4.0, 1e-6)
        << "two cells for each of two voxels";
    EXPECT_NEAR(hits.segments, hits.steps, 1e-9);
    object.extinction = base::Vec3f(100.0f);
    hits = expected_hits(one(object), square_view(), false, false);
    EXPECT_NEAR(hits.inside, 0.04 * 0.0921, 1e-5) << "of which nothing is seen behind an optical depth of 9.21";
}

// Nothing is looked up where a camera sees what no map holds.
TEST(SeenPlaces, are_in_the_map_by_their_share_of_the_picture) {
    scene::Object object;
    scene::Mesh ground;
    ground.positions = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
    ground.triangles = {{0, 1, 2}, {0, 2, 3}};
    object.shape = ground;
    const rays::LightView above = camera_view({{0, 0, 20}, {0, 0, 0}}, {200, 200});
    rays::LightView map = square_view();
    EXPECT_EQ(share_in_map(object, above, map), 1.0);
    map.resolution = {50, 100};
    EXPECT_NEAR(share_in_map(object, above, map), 0.5, 0.01);
    object.shape = scene::Hair{{{1, 1, 1}, {2, 2, 1}, {-3, 1, 1}, {-2, 2, 1}}, {1, 1, 1, 1}, {0, 2, 4}};
    EXPECT_NEAR(share_in_map(object, above, map), 0.5, 1e-9);
    EXPECT_EQ(share_in_map(object, camera_view({{0, 0, 20}, {0, 0, 40}}, {200, 200}), map), 1.0)
        << "behind the camera nothing is known";
}

// Only tiles that hold queries are captured for the truth.
TEST(SeenPlaces, cover_their_share_of_the_map) {
    scene::Object object;
    scene::Mesh ground;
    ground.positions = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
    ground.triangles = {{0, 1, 2}, {0, 2, 3}};
    object.shape = ground;
    const rays::LightView map = square_view();
    EXPECT_EQ(seen_share_of_map(one(object), camera_view({{0, 0, 20}, {0, 0, 0}}, {200, 200}), map), 1.0);
    scene::Camera close{{0, 0, 5.0}, {0, 0, 0}};
    close.fov = 53.13;  // 5 by 5 lengths
    EXPECT_NEAR(seen_share_of_map(one(object), camera_view(close, {200, 200}), map), 0.25, 0.15) << "and the border";
    EXPECT_EQ(seen_share_of_map(one(object), camera_view({{0, 0, 20}, {0, 0, 40}}, {200, 200}), map), 1.0);
}

TEST_F(CountedWork, is_that_of_the_map_the_truth_and_the_techniques) {
    const LightWork work = count({{"deep"}, {"avsm"}, {"ray_traced", R"({"samples": 9})"}, {"ray_traced", "{}"}});
    EXPECT_EQ(work.pixels, 1e4);
    EXPECT_EQ(work.rays, 1.6e5);
    EXPECT_NEAR(work.segments, 1.0, 1e-6);
    EXPECT_EQ(work.truth_rays, 6.4e5) << "queries in every tile";
    EXPECT_EQ(work.truth_samples, 64.0) << "a footprint of a pixel";
    EXPECT_EQ(work.truth_sets, 8.0);
    EXPECT_EQ(work.samples, 16.0);
    EXPECT_EQ(work.compared, 20000.0);
    EXPECT_EQ(work.footprint, 16.0);
    EXPECT_EQ(work.receivers, 65536.0);
    EXPECT_EQ(work.judged, 4096.0);
    EXPECT_EQ(work.spread_seeds, 4.0);
    EXPECT_EQ(work.techniques, 2.0);
    EXPECT_EQ(work.traced, 2.0);
    EXPECT_EQ(work.lookup_rays, 9.0 + count({{"ray_traced"}}).lookup_rays) << "not as many as the map has";
    EXPECT_EQ(work.in_media, 0.0);
    EXPECT_EQ(work.fine, 0.0);
    EXPECT_TRUE(work.shared) << "avsm is made of means";
    EXPECT_FALSE(count({{"deep"}}).shared) << "without media it is not";
}

TEST_F(CountedWork, grows_with_the_softness_of_the_light) {
    scenario_.lights[0].softness = scene::FilterWidth{scene::WidthUnit::length, 1.0};
    const LightWork work = count();
    EXPECT_NEAR(work.footprint, 1600.0, 1e-6) << "10 by 10 pixels of 16 rays";
    EXPECT_NEAR(work.truth_samples, 6400.0, 1e-6);
}

// Each receiver has one face of a point light.
TEST_F(CountedWork, of_a_face_is_a_sixth_of_the_receivers) {
    scenario_.receivers.points.assign(6000, base::Vec3d(0.0));
    EXPECT_EQ(count().receivers, 6000.0);
    scenario_.lights[0].face = 5;
    EXPECT_NEAR(count().receivers, 1000.0, 1e-9);
    EXPECT_NEAR(count().judged, 1000.0, 1e-9);
}

// Sweeps load a scene once.
TEST(FileBytes, are_those_of_the_files_that_a_variant_reads) {
    const TemporaryFolder folder;
    const std::string mesh = "v -1 1 -1\nv 1 1 -1\nv 1 1 1\nf 1 2 3\n";
    for (const char* name : {"a.obj", "b.obj"}) std::ofstream(folder.path() / name) << mesh;
    const nlohmann::json document = nlohmann::json::parse(R"({
        "name": "files",
        "scene": {"objects": [{"type": "mesh", "file": "a.obj"}, {"type": "mesh", "file": "b.obj"}]},
        "lights": [{"type": "directional", "direction": [0, -1, 0]}],
        "techniques": [{"type": "deep"}],
        "sweeps": {"/rays/seed": [1, 2]}})");
    scene::SearchPath path;
    path.folders = {folder.path()};
    ScenarioLoader loader(path);
    const std::vector<document::Variant> variants = document::expand(document);
    loader.load(variants[0]);
    EXPECT_EQ(loader.file_bytes(), 2 * mesh.size());
    loader.load(variants[1]);
    EXPECT_EQ(loader.file_bytes(), 0u);
}

}  // namespace
}  // namespace shadowbench::bench
