#include "bench/agreement.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "rays/capture.h"
#include "rays/tracer.h"
#include "scene/scenario.h"

namespace shadowbench::bench {
namespace {

using nlohmann::json;

// Seen from above through a map of [-1, 1] x [-1, 1], one ray in the middle of each of 32 x 32 pixels. The middles lie
// exactly on the diagonals of squares that are aligned with the map.
scene::Scenario seen_from_above(const json& objects) {
    return scene::load_scenario({{"name", "above"},
                                 {"scene", {{"objects", objects}}},
                                 {"lights",
                                  {{{"type", "directional"},
                                    {"direction", {0, -1, 0}},
                                    {"target", {0, 0, 0}},
                                    {"extent", {2, 2}},
                                    {"up", {0, 0, -1}}}}},
                                 {"rays", {{"resolution", 32}, {"samples_per_pixel", 1}, {"pattern", "regular"}}},
                                 {"receivers", {{"type", "probes"}, {"count", 10}}},
                                 {"techniques", {{{"type", "uncompressed"}}}}},
                                {});
}

json rectangle(double height, double across, double down, double opacity) {
    return {{"type", "quad"},
            {"corner", {-0.5 * across, height, -0.5 * down}},
            {"edge_u", {across, 0, 0}},
            {"edge_v", {0, 0, down}},
            {"opacity", opacity}};
}

json square(double height, double side, double opacity) {
    return rectangle(height, side, side, opacity);
}

// Captures the one scene and traces the other.
results::Agreement compare(const json& captured, const json& traced) {
    const scene::Scenario ours = seen_from_above(captured), theirs = seen_from_above(traced);
    const rays::LightView view = rays::make_light_view(ours.lights[0], ours.scene, ours.rays.resolution, "");
    rays::MapLayout layout;
    layout.width = layout.height = layout.tile_width = layout.tile_height = 32;
    layout.z_min = static_cast<float>(view.z_min);
    layout.z_max = static_cast<float>(view.z_max);
    const rays::Capture capture(ours.scene, view, layout);
    return compare_with_tracer(capture, layout, view, rays::Tracer(theirs.scene, true), 10'000);
}

TEST(Agreement, a_ray_through_a_shared_edge_is_no_disagreement) {
    const json squares{square(0, 2, 0.5), square(0.5, 4, 0.005), square(1, 1, 1)};
    const results::Agreement agreement = compare(squares, squares);
    EXPECT_EQ(agreement.rays, 1024u);
    EXPECT_EQ(agreement.other_crossings, 0u);
    EXPECT_EQ(agreement.other_transmittance, 0u);
}

TEST(Agreement, a_ray_through_an_outer_edge_is_no_disagreement) {
    // Its edges pass through the middles of pixels, for the tracer on the other side of them.
    const double side = 34.0 / 32.0, hair = 1e-5;
    const results::Agreement agreement =
        compare({square(0, 4, 0.5), square(1, side + hair, 0.5)}, {square(0, 4, 0.5), square(1, side - hair, 0.5)});
    EXPECT_EQ(agreement.other_crossings, 0u);
    EXPECT_EQ(agreement.other_transmittance, 0u);
}

TEST(Agreement, counts_the_rays_through_a_surface_that_one_side_lacks) {
    // No ray meets the diagonal of the ground, which Embree counts twice, nor the speck, which gives both scenes the
    // same depths.
    const json ground = rectangle(0, 4, 3, 0.5), speck = square(2, 0.01, 0.5);
    const json both{ground, speck, square(1, 1, 0.5)}, one{ground, speck};
    for (const auto& [captured, traced] : {std::pair{both, one}, std::pair{one, both}}) {
        const results::Agreement agreement = compare(captured, traced);
        EXPECT_EQ(agreement.other_crossings, 16u * 16u);
        EXPECT_EQ(agreement.other_transmittance, 16u * 16u);
        EXPECT_FALSE(results::agrees(agreement));
    }
}

// On the diagonals of squares, too.
TEST(Agreement, counts_a_surface_that_the_capture_finds_twice) {
    const json once{square(0, 4, 0.5), square(1, 1, 0.5)},
        twice{square(0, 4, 0.5), square(1, 1, 0.5), square(1, 1, 0.5)};
    EXPECT_EQ(compare(twice, once).other_crossings, 16u * 16u);
}

TEST(Agreement, counts_another_opacity) {
    const results::Agreement agreement = compare(json::array({square(0, 1, 0.5)}), json::array({square(0, 1, 0.51)}));
    EXPECT_EQ(agreement.other_crossings, 0u);
    EXPECT_EQ(agreement.other_transmittance, 16u * 16u);
}

}  // namespace
}  // namespace shadowbench::bench
