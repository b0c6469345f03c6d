#include "render/light_map.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "render/render.h"

namespace shadowbench::render {
namespace {

using base::Vec2i;
using base::Vec3f;
using nlohmann::json;

// A light vertically above: its map's x axis is -x, its y axis z. One quad lies at x > 0, z > 0, the other opposite.
LightMap map_of(const json& resolution, const json& opacity) {
    json document = json::parse(R"({
        "name": "two_quads",
        "scene": {"objects": [
            {"type": "quad", "corner": [0, 0, 0], "edge_u": [1, 0, 0], "edge_v": [0, 0, 1]},
            {"type": "quad", "corner": [-1, 0, -1], "edge_u": [1, 0, 0], "edge_v": [0, 0, 1]},
            {"type": "quad", "corner": [-1, -1, -1], "edge_u": [1, 0, 0], "edge_v": [0, 0, 1]}]},
        "lights": [{"type": "directional", "name": "lamp", "direction": [0, -1, 0], "extent": [2.5, 2.5]}],
        "rays": {"samples_per_pixel": 4},
        "receivers": {"type": "camera", "position": [0, 3, 3], "target": [0, 0, 0], "resolution": [16, 12]},
        "reference": {"samples_per_pixel": 16, "queries": 10},
        "techniques": [{"type": "shadow_map"}]})");
    document["rays"]["resolution"] = resolution;
    for (const int i : {1, 2}) document["scene"]["objects"][i]["opacity"] = opacity;
    return render(document, {}, {}).lights.at(0);
}

TEST(LightMap, ShowsTransmittanceAsTheLightSeesIt) {
    const LightMap seen = map_of(8, 0.5);
    EXPECT_EQ(seen.light, "lamp");
    EXPECT_EQ(seen.map, Vec2i(8, 8));
    ASSERT_EQ(Vec2i(seen.through.width, seen.through.height), Vec2i(8, 8));
    EXPECT_EQ(seen.through.at(2, 2), Vec3f(0.0f));
    EXPECT_EQ(seen.through.at(5, 5), Vec3f(0.25f));
    EXPECT_EQ(seen.through.at(5, 2), Vec3f(1.0f));
    EXPECT_EQ(seen.through.at(2, 5), Vec3f(1.0f));
}

TEST(LightMap, HasColours) {
    EXPECT_EQ(map_of(8, {0.0, 0.5, 1.0}).through.at(5, 5), Vec3f(1.0f, 0.25f, 0.0f));
}

TEST(LightMap, OfALargeMapIsTheMeanOfItsPixels) {
    const LightMap seen = map_of({2048, 8}, 0.5);
    EXPECT_EQ(seen.map, Vec2i(2048, 8));
    ASSERT_EQ(Vec2i(seen.through.width, seen.through.height), Vec2i(longest_light_map, 4));
    EXPECT_EQ(seen.through.at(500, 1), Vec3f(0.0f));
    EXPECT_EQ(seen.through.at(520, 2), Vec3f(0.25f));
    EXPECT_EQ(seen.through.at(0, 0), Vec3f(1.0f));
}

}  // namespace
}  // namespace shadowbench::render
