// Scenes and lights at the ends of every range that the schema allows: each scene is refused at the place of its fault,
// or gives light rays and queries whose numbers are finite and in range.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "bench/queries.h"
#include "rays/capture.h"
#include "scene/scenario.h"

namespace shadowbench::bench {
namespace {

using nlohmann::json;

const std::vector<const char*> odd_objects = {
    R"({"type": "sphere", "centre": [0, 0, 0], "radius": 1})",
    R"({"type": "sphere", "centre": [0, 0, 0], "radius": 1e-18})",
    R"({"type": "sphere", "centre": [0, 0, 0], "radius": 1e18})",
    R"({"type": "sphere", "centre": [1e18, -1e18, 1e18], "radius": 1e18, "motion": [1e18, 1e18, -1e18]})",
    R"({"type": "sphere", "centre": [1e18, 0, 0], "radius": 1})",
    R"({"type": "spheres", "centres": [[0, 0, 0], [1e18, 1e18, 1e18]], "radii": [1e-18, 1], "opacity": 1e-30})",
    R"({"type": "quad", "corner": [-1, 0, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2]})",
    R"({"type": "quad", "corner": [-1, 0, -1], "edge_u": [0, 0, 0], "edge_v": [0, 0, 2]})",
    R"({"type": "quad", "corner": [-1, 0, -1], "edge_u": [2, 0, 0], "edge_v": [2, 0, 1e-9]})",
    R"({"type": "quad", "corner": [1e6, 0, 0], "edge_u": [1e-300, 0, 0], "edge_v": [0, 0, 1e-300]})",
    R"({"type": "quad", "corner": [1e18, 1e18, 1e18], "edge_u": [1e18, 0, 0], "edge_v": [0, 0, 1e18]})",
    R"({"type": "quad", "corner": [-1e18, -1e18, 0], "edge_u": [1e18, 1e18, 0], "edge_v": [0, 1e18, 1e18],
        "motion": [0, -1e18, 1e18]})",
    R"({"type": "layers", "corner": [-1, 0, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2], "offset": [0, 1e-300, 0],
        "count": 50})",
    R"({"type": "layers", "corner": [-1, 0, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2], "offset": [0, 1e18, 0],
        "count": 50})",
    R"({"type": "mesh", "vertices": [[0, 0, 0], [0, 0, 0], [1, 1, 1]], "triangles": [[0, 1, 2], [2, 2, 2]]})",
    R"({"type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 0, 1]], "triangles": [[0, 1, 2]], "scale": 1e18,
        "translate": [1e18, 0, 0]})",
    R"({"type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 0, 1]], "triangles": [[0, 1, 2]], "scale": 1e-18})",
    R"({"type": "mesh", "vertices": [[1e-40, 0, 0], [1e-310, 1e-45, 0], [0, 0, 1e-44]], "triangles": [[0, 1, 2]]})",
    R"({"type": "hair_ball", "strands": 40, "segments": 3, "centre": [1e18, 1e18, -1e18], "ball_radius": 1e18,
        "length": 1e18, "curl_radius": 1e18, "radius": 1e18})",
    R"({"type": "hair_ball", "strands": 40, "segments": 3, "ball_radius": 1e-18, "length": 1e-18, "curl_radius": 0,
        "radius": 1e-18})",
    R"({"type": "hair_ball", "strands": 40, "segments": 3, "radius": 1e-18, "motion": [0, 1e-18, 0]})",
    R"({"type": "particles", "centres": [[0, 0, 0]], "radii": [1e18], "density": [1e18], "extinction": 1e18})",
    R"({"type": "particles", "centres": [[0, 0, 0], [0, 0, 0]], "radii": [1e-18, 1], "density": [1e18, 1e-18],
        "extinction": [0, 1e-18, 1e18], "motion": [1e18, 0, 0]})",
    R"({"type": "smoke_column", "particles": 20, "height": 1e18, "width": 1e18, "puff_radius": 1e18, "density": 1e18})",
    R"({"type": "smoke_column", "particles": 20, "height": 1e-18, "width": 1e-18, "puff_radius": 1e-18})",
    R"({"type": "density_box", "size": [2, 3, 4], "extinction": 1e18})",
    R"({"type": "density_box", "size": [2, 2, 2], "lower": [-1e18, -1e18, -1e18], "upper": [1e18, 1e18, 1e18]})",
    R"({"type": "density_box", "size": [2, 2, 2], "lower": [0, 0, 0], "upper": [1e-310, 1, 1]})",
    R"({"type": "density_box", "size": [2, 2, 2], "lower": [0, 0, 0], "upper": [1e-18, 1e-18, 1e-18]})",
    R"({"type": "density_box", "size": [2, 2, 2], "lower": [1, 1, 1], "upper": [1.0000000000000002, 2, 2]})",
    R"({"type": "density_box", "size": [2, 2, 2], "lower": [1e9, 1e9, 1e9], "upper": [1000000001, 1000000001, 1000000001],
        "motion": [1e18, 0, 0]})",
    R"({"type": "density_box", "size": [2, 2, 2], "step": 1e-18})",
    R"({"type": "density_box", "size": [2, 2, 2], "step": 1e18})",
    R"({"type": "density_box", "size": [2, 2, 2], "step": 1e-3, "lower": [-1, -2, -1], "motion": [0, 1e-30, 0]})",
    R"({"type": "crossed_rods", "size": [4, 4, 4], "lower": [-1e-18, 0, 0], "upper": [1e18, 1, 1e-17], "radius": 1e18})",
    R"({"type": "cloud", "size": [4, 4, 4], "lower": [0, 0, 0], "upper": [1e-17, 1e18, 1], "octaves": 12})",
};

const std::vector<const char*> odd_lights = {
    R"({"type": "directional", "direction": [0.1, -1, 0.2]})",
    R"({"type": "directional", "direction": [0, -1e-300, 0], "up": [0, 0, 1e-310]})",
    R"({"type": "directional", "direction": [1e18, -1e18, 1e-18], "up": [1e-200, 0, 0]})",
    R"({"type": "directional", "direction": [0, -1, 0], "up": [1e-9, 1, 0]})",
    R"({"type": "directional", "direction": [0, -1, 0], "up": [0, 0, 0]})",
    R"({"type": "directional", "direction": [0, 0, 0]})",
    R"({"type": "directional", "direction": [0.3, -1, 0.2], "target": [1e18, 1e18, 1e18]})",
    R"({"type": "directional", "direction": [0.3, -1, 0.2], "target": [1e6, 0, -1e6], "extent": [1e7, 1e7]})",
    R"({"type": "directional", "direction": [0, -1, 0], "extent": [1e-18, 1e-18]})",
    R"({"type": "directional", "direction": [0, -1, 0], "extent": [1e18, 1e18]})",
    R"({"type": "directional", "direction": [0, -1, 0], "extent": [0, 1]})",
    R"({"type": "spot", "position": [0, 5, 0], "target": [0, 0, 0]})",
    R"({"type": "spot", "position": [0, 5, 0], "target": [0, 5, 0]})",
    R"({"type": "spot", "position": [0, 0, 0], "target": [1e-300, 0, 0], "angle": 90})",
    R"({"type": "spot", "position": [0, 0, 0], "target": [1e-18, 0, 0], "angle": 178.999})",
    R"({"type": "spot", "position": [0, 5, 0], "target": [0, 0, 0], "angle": 1e-300})",
    R"({"type": "spot", "position": [0, 5, 0], "target": [0, 0, 0], "angle": 1e-6})",
    R"({"type": "spot", "position": [0.1, 0.2, 0], "target": [0, 0, 0], "angle": 178.999, "near": 1e-300})",
    R"({"type": "spot", "position": [0, 5, 0], "target": [0, 0, 0], "angle": 90, "near": 1e18})",
    R"({"type": "spot", "position": [1e18, 1e18, 1e18], "target": [-1e18, -1e18, -1e18], "angle": 1})",
    R"({"type": "spot", "position": [1e18, 0, 0], "target": [0, 0, 0]})",
    R"({"type": "spot", "position": [0, 1e9, 0], "target": [0, 0, 0], "angle": 90, "up": [0, 1, 1e-3]})",
};

void expect_finite(const rays::LightView& view) {
    for (const base::Vec3d& v : {view.origin, view.right, view.up, view.forward})
        for (int axis = 0; axis < 3; ++axis) EXPECT_TRUE(std::isfinite(v[axis]));
    for (const base::Vec2d& v : {view.lower, view.pixel, base::Vec2d(view.z_min, view.z_max)})
        EXPECT_TRUE(std::isfinite(v.x) && std::isfinite(v.y));
    EXPECT_GT(view.pixel.x, 0.0);
    EXPECT_GT(view.pixel.y, 0.0);
    EXPECT_FALSE(std::isnan(view.z_near));
}

void expect_in_range(const rays::LightRays& tile, const rays::MapLayout& layout) {
    for (std::size_t ray = 0; ray < tile.rays(); ++ray)
        for (std::size_t s = tile.begin[ray]; s < tile.begin[ray + 1]; ++s) {
            ASSERT_TRUE(tile.z_front[s] >= layout.z_min && tile.z_front[s] <= layout.z_max) << tile.z_front[s];
            ASSERT_TRUE(tile.back(s) >= tile.z_front[s] && tile.back(s) <= layout.z_max) << tile.back(s);
            if (s > tile.begin[ray]) {
                ASSERT_GE(tile.z_front[s], tile.z_front[s - 1]);
            }
            for (int c = 0; c < tile.channels; ++c) {
                const float t = tile.transmittance[s * static_cast<std::size_t>(tile.channels) + c];
                ASSERT_TRUE(t >= 0.0f && t <= 1.0f) << t;
            }
        }
}

void expect_finite(const QuerySet& asked) {
    for (const techniques::Query& q : asked.queries) {
        ASSERT_TRUE(std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z));
        ASSERT_GT(q.width, 0.0f);
    }
}

TEST(OddScenes, are_refused_at_their_place_or_give_numbers_in_range) {
    int refused = 0, captured = 0;
    for (const char* object : odd_objects)
        for (const char* light : odd_lights) {
            SCOPED_TRACE(std::string(object) + " " + light);
            json document = {{"name", "odd"}, {"techniques", {{{"type", "deep"}}}}};
            document["scene"]["objects"] = {json::parse(object)};
            document["lights"] = {json::parse(light)};
            document["rays"] = {{"resolution", {5, 4}}, {"samples_per_pixel", 4}};
            document["receivers"] = {{"type", "probes"}, {"count", 50}, {"filter_width", 1e-6}};
            try {
                const scene::Scenario scenario = scene::load_scenario(document, {});
                const rays::LightView view =
                    rays::make_light_view(scenario.lights[0], scenario.scene, scenario.rays.resolution, "/lights/0");
                expect_finite(view);
                rays::MapLayout layout = rays::make_layout(scenario.scene, view, scenario.rays);
                const rays::Capture capture(scenario.scene, view, layout);
                for (int tile = 0; tile < layout.tiles(); ++tile) expect_in_range(capture.tile(tile), layout);
                expect_finite(probe_queries(scenario.receivers, view));
                ++captured;
            } catch (const base::Error& error) {
                EXPECT_EQ(error.code(), base::ErrorCode::bad_input) << error.what();
                EXPECT_TRUE(error.where().starts_with("/")) << error.what();
                ++refused;
            }
        }
    EXPECT_GT(refused, 100);
    EXPECT_GT(captured, 300);
}

}  // namespace
}  // namespace shadowbench::bench
