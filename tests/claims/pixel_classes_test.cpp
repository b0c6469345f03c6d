#include "claims/pixel_classes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace shadowbench::claims {
namespace {

// A wall across the light over the left half of the map, and a wall over all of it further down.
nlohmann::json two_walls(bool lower_casts) {
    nlohmann::json document = nlohmann::json::parse(R"({
        "name": "two_walls",
        "scene": {"objects": [
            {"type": "quad", "corner": [-1, 1, -1], "edge_u": [1, 0, 0], "edge_v": [0, 0, 2]},
            {"type": "quad", "corner": [-2, 0, -2], "edge_u": [4, 0, 0], "edge_v": [0, 0, 4]}
        ]},
        "lights": [{"type": "directional", "direction": [0, -1, 0], "target": [0, 0, 0], "extent": [2, 2]}],
        "rays": {"resolution": 32, "samples_per_pixel": 4},
        "techniques": [{"type": "deep"}, {"type": "uncompressed"}]
    })");
    document["scene"]["objects"][1]["casts_shadow"] = lower_casts;
    return document;
}

TEST(PixelClasses, APixelIsCrossedIfAnyOfItsRaysMeetsSomething) {
    const std::vector<char> upper = crossed_pixels(two_walls(false), {});
    ASSERT_EQ(upper.size(), 32u * 32u);
    EXPECT_EQ(std::count(upper.begin(), upper.end(), 1), 16 * 32);
    const std::vector<char> all = crossed_pixels(two_walls(true), {});
    EXPECT_EQ(std::count(all.begin(), all.end(), 1), 32 * 32);
}

// A step is two vertices. Behind the upper wall no light is left that the lower one could stop.
TEST(PixelClasses, VerticesAreCountedForEachClass) {
    const std::vector<char> upper = crossed_pixels(two_walls(false), {});
    const std::vector<MeanVertices> alone = mean_vertices(two_walls(false), {}, upper);
    ASSERT_EQ(alone.size(), 2u);
    EXPECT_EQ(alone[0].chosen, 2.0);
    EXPECT_EQ(alone[0].others, 0.0);
    EXPECT_EQ(alone[0].all, 1.0);
    const std::vector<MeanVertices> both = mean_vertices(two_walls(true), {}, upper);
    EXPECT_EQ(both[0].chosen, 2.0);
    EXPECT_EQ(both[0].others, 2.0);
    EXPECT_EQ(both[0].all, 2.0);
}

}  // namespace
}  // namespace shadowbench::claims
