#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include "scene/scenario.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using nlohmann::json;
using test::error_of;

Scenario load(const char* lights) {
    json document = json::parse(R"({
        "name": "lights",
        "scene": {"objects": [{"type": "sphere", "centre": [3, 4, 5], "radius": 1}]},
        "techniques": [{"type": "deep"}]
    })");
    document["lights"] = json::parse(lights);
    return load_scenario(document, {});
}

std::string place(const char* lights) {
    return error_of([&] { load(lights); }).where();
}

TEST(LoadLight, DirectionalHasUnitDirectionAndLooksAtTheCasters) {
    const Light light = load(R"([{"type": "directional", "direction": [0, 0, -4]}])").lights[0];
    EXPECT_EQ(light.type, LightType::directional);
    EXPECT_EQ(light.name, "directional_0");
    EXPECT_EQ(light.direction, Vec3d(0, 0, -1));
    EXPECT_EQ(light.target, Vec3d(3, 4, 5));
    EXPECT_FALSE(light.extent);
    EXPECT_FALSE(light.up);
}

TEST(LoadLight, ReadsEveryKey) {
    const auto lights = load(R"([
        {"type": "directional", "name": "sun", "direction": [0, -1, 0], "target": [1, 2, 3], "extent": [4, 5],
         "up": [1, 0, 0], "colour": [1, 0.5, 0]},
        {"type": "spot", "position": [0, 9, 0], "target": [0, 0, 0], "angle": 30, "near": 0.5, "up": [0, 0, 1],
         "colour": 2}])")
                            .lights;
    EXPECT_EQ(lights[0].name, "sun");
    EXPECT_EQ(lights[0].target, Vec3d(1, 2, 3));
    EXPECT_EQ(*lights[0].extent, Vec2d(4, 5));
    EXPECT_EQ(*lights[0].up, Vec3d(1, 0, 0));
    EXPECT_EQ(lights[0].colour, Vec3f(1, 0.5f, 0));
    EXPECT_EQ(lights[1].type, LightType::spot);
    EXPECT_EQ(lights[1].name, "spot_1");
    EXPECT_EQ(lights[1].position, Vec3d(0, 9, 0));
    EXPECT_EQ(*lights[1].angle, 30.0);
    EXPECT_EQ(lights[1].near, 0.5);
    EXPECT_EQ(lights[1].colour, Vec3f(2, 2, 2));
}

TEST(LoadLight, LightsThatCastNoShadowHaveNoMapAndKeepTheirPlaces) {
    const char* lights = R"([{"type": "directional", "direction": [0, -1, 0], "casts_shadow": false},
                             {"type": "directional", "direction": [0, -1, 0], "softness": {"length": 0.5}},
                             {"type": "spot", "position": [0, 9, 0], "target": [0, 0, 0], "softness": {"share": 0.25}}])";
    const Scenario scenario = load(lights);
    ASSERT_EQ(scenario.lights.size(), 2u);
    ASSERT_EQ(scenario.fills.size(), 1u);
    EXPECT_EQ(scenario.fills[0].name, "directional_0");
    EXPECT_EQ(scenario.lights[0].name, "directional_1");
    EXPECT_EQ(scenario.lights[0].where, "/lights/1") << "errors must point into the file";
    EXPECT_EQ(scenario.lights[1].where, "/lights/2");
    EXPECT_FALSE(scenario.fills[0].softness);
    EXPECT_TRUE((scenario.lights[0].softness == FilterWidth{WidthUnit::length, 0.5}));
    EXPECT_TRUE((scenario.lights[1].softness == FilterWidth{WidthUnit::share, 0.25}));
    EXPECT_THAT(notes(scenario), testing::ElementsAre(testing::HasSubstr("\"directional_0\" casts no shadow")));

    json document = json::parse(R"({"scene": {"objects": []}, "receivers": {"filter_width": 3}})");
    document["lights"] = json::parse(lights);
    EXPECT_EQ(light_names(document), (std::vector<std::string>{"directional_1", "spot_2"}));
    EXPECT_TRUE((lookup_width(document, "directional_1") == FilterWidth{WidthUnit::length, 0.5}));
    EXPECT_TRUE((lookup_width(document, "other") == FilterWidth{WidthUnit::map_pixels, 3.0}));
}

TEST(LoadLight, PointLightsBecomeSixFacesThatShareAPlaceInTheFile) {
    const char* lights = R"([{"type": "directional", "direction": [0, -1, 0]},
                             {"type": "point", "name": "lamp", "position": [1, 2, 3], "colour": 2, "border": 0.5,
                              "near": 0.25, "softness": {"share": 0.1}, "faces": ["-y", "+x"]}])";
    const Scenario scenario = load(lights);
    ASSERT_EQ(scenario.lights.size(), 3u);
    ASSERT_EQ(scenario.fills.size(), 4u) << "the light shines through faces without a map";
    EXPECT_EQ(scenario.lights[1].name, "lamp +x");
    EXPECT_EQ(scenario.lights[2].name, "lamp -y");
    EXPECT_EQ(scenario.lights[2].direction, Vec3d(0, -1, 0));
    EXPECT_EQ(scenario.lights[2].face, 3);
    for (const Light* face : {&scenario.lights[1], &scenario.lights[2], &scenario.fills[0], &scenario.fills[3]}) {
        EXPECT_EQ(face->type, LightType::spot);
        EXPECT_EQ(face->where, "/lights/1");
        EXPECT_EQ(face->position, Vec3d(1, 2, 3));
        EXPECT_EQ(face->colour, Vec3f(2, 2, 2));
        EXPECT_EQ(face->border, 0.5);
        EXPECT_EQ(face->near, 0.25);
        EXPECT_TRUE(face->softness.has_value());
        // The farthest corner of the casters is [4, 5, 6].
        EXPECT_NEAR((face->target - face->position).length(), std::sqrt(27.0), 1e-12);
    }
    json document = json::parse(R"({"scene": {"objects": []}})");
    document["lights"] = json::parse(lights);
    EXPECT_EQ(light_names(document), (std::vector<std::string>{"directional_0", "lamp +x", "lamp -y"}));
    EXPECT_TRUE((lookup_width(document, "lamp -y") == FilterWidth{WidthUnit::share, 0.1}));
    EXPECT_EQ(load(R"([{"type": "point", "position": [1, 2, 3]}])").lights.size(), 6u);
    const Scenario fill = load(R"([{"type": "directional", "direction": [0, -1, 0]},
                                   {"type": "point", "position": [1, 2, 3], "casts_shadow": false}])");
    ASSERT_EQ(fill.fills.size(), 1u);
    EXPECT_FALSE(fill.fills[0].face) << "it lights everything at once";
}

// A border of 1/8 has room for 1/9 of the map; a width of 0.2 takes a border of 1/4.
TEST(LoadLight, NotesFacesWithoutMapsAndBordersThatAreTooNarrow) {
    Scenario scenario = load(R"([{"type": "directional", "direction": [0, -1, 0]},
        {"type": "point", "name": "a", "position": [1, 2, 3], "softness": {"share": 0.1}},
        {"type": "point", "name": "b", "position": [1, 2, 3], "softness": {"share": 0.2}},
        {"type": "point", "name": "c", "position": [1, 2, 3], "faces": ["+x", "-x", "+y", "-y", "+z"]}])");
    EXPECT_THAT(notes(scenario), testing::ElementsAre(testing::HasSubstr("/lights/2: lookups are 0.2 of a map wide"),
                                                      testing::HasSubstr("/lights/3: face \"c -z\" has no map")));
    EXPECT_THAT(notes(scenario)[0], testing::HasSubstr("room for 0.111, so at seams a part is cut off: give it a "
                                                       "border of 0.25 or more"));
    scenario.rays.resolution = {64, 16};  // 2 of the 16 pixels that span the face: more than 1/9
    scenario.receivers.filter_width = {WidthUnit::map_pixels, 2.0};
    const std::vector<std::string> narrow = notes(scenario);
    ASSERT_EQ(narrow.size(), 4u);
    EXPECT_THAT(narrow[0], testing::HasSubstr("/lights/1: lookups are 0.4 of"));
    EXPECT_THAT(narrow[2], testing::HasSubstr("/lights/3: lookups are 0.125 of"));
    scenario.receivers.filter_width.value = 1.0;
    EXPECT_EQ(notes(scenario).size(), 3u);
    scenario.receivers.filter_width = {WidthUnit::share, 0.5};  // of 64: more than the face
    EXPECT_THAT(notes(scenario)[2], testing::HasSubstr("make them narrower"));
}

// A lookup 1 wide, at planar depth z, reaches 1 / (2 z) of the face over its edge: over a border of 1/8 if z is
// below 4.
TEST(LoadLight, NotesBordersThatAreTooNarrowForLengthsWhereTheyAreKnownToBe) {
    Scenario scenario = load(R"([{"type": "point", "name": "a", "position": [0, 0, 0], "softness": {"length": 1}}])");
    scenario.scene.objects.clear();
    scenario.rays.resolution = {64, 64};
    EXPECT_TRUE(notes(scenario).empty()) << "nothing is known of receivers";
    scenario.receivers.points = {{2, 0, 0}, {5, 4.9, 0}};  // in the middle of a face; beside an edge, but far
    EXPECT_TRUE(notes(scenario).empty());
    scenario.receivers.points.emplace_back(0, 1.9, -2);  // 1/4 over an edge
    ASSERT_EQ(notes(scenario).size(), 1u);
    EXPECT_THAT(notes(scenario)[0], testing::HasSubstr("lookups are 0.222 of a map wide"));
    EXPECT_THAT(notes(scenario)[0], testing::HasSubstr("a border of 0.25 or more"));
    for (Light& light : scenario.lights) light.border = 0.25;
    EXPECT_TRUE(notes(scenario).empty());
    // Everything that a camera could see is nearer than 4.
    scenario.receivers.points.clear();
    scenario.scene.objects.emplace_back().shape = Spheres{{Vec3f(0, 0, -1)}, {0.5f}};
    ASSERT_EQ(notes(scenario).size(), 1u);
    EXPECT_THAT(notes(scenario)[0], testing::HasSubstr("at seams a part is cut off"));
    scenario.scene.objects[0].shape = Spheres{{Vec3f(0, 0, -9)}, {0.5f}};
    EXPECT_TRUE(notes(scenario).empty());
}

TEST(LoadLight, RefusesFacesThatAreNone) {
    EXPECT_EQ(place(R"([{"type": "point", "position": [1, 2, 3], "faces": []}])"), "/lights/0/faces");
    EXPECT_EQ(place(R"([{"type": "point", "position": [1, 2, 3], "faces": ["x"]}])"), "/lights/0/faces/0");
    EXPECT_EQ(place(R"([{"type": "point", "position": [1, 2, 3], "border": 0}])"), "/lights/0/border");
    EXPECT_EQ(place(R"([{"type": "point"}])"), "/lights/0");
    EXPECT_EQ(place(R"([{"type": "point", "name": "a", "position": [1, 2, 3]},
                        {"type": "directional", "name": "a +z", "direction": [0, -1, 0]}])"),
              "/lights/1/name");
}

TEST(LoadLight, RefusesScenesWithoutAnyShadowAndWidthsThatAreNone) {
    EXPECT_EQ(place(R"([{"type": "directional", "direction": [0, -1, 0], "casts_shadow": false}])"), "/lights");
    EXPECT_EQ(place(R"([{"type": "directional", "direction": [0, -1, 0], "softness": 2}])"), "/lights/0/softness");
    EXPECT_EQ(place(R"([{"type": "directional", "direction": [0, -1, 0], "softness": {"length": 0}}])"),
              "/lights/0/softness/length");
    EXPECT_EQ(place(R"([{"type": "directional", "direction": [0, -1, 0], "softness": {"share": 1, "length": 1}}])"),
              "/lights/0/softness");
    EXPECT_EQ(place(R"([{"type": "directional", "direction": [0, -1, 0], "casts_shadow": false},
                        {"type": "directional", "direction": [0, -1, 0], "name": "directional_0"}])"),
              "/lights/1/name");
}

TEST(LoadLight, RefusesDirectionsWithoutLength) {
    EXPECT_EQ(place(R"([{"type": "directional", "direction": [0, 0, 0]}])"), "/lights/0/direction");
    EXPECT_EQ(place(R"([{"type": "spot", "position": [1, 1, 1], "target": [1, 1, 1]}])"), "/lights/0/target");
    EXPECT_EQ(place(R"([{"type": "directional", "direction": [0, 3, 0], "up": [0, -1, 0]}])"), "/lights/0/up");
    EXPECT_EQ(place(R"([{"type": "directional", "direction": [0, 3, 0], "up": [0, 0, 0]}])"), "/lights/0/up");
    EXPECT_EQ(place(R"([{"type": "spot", "position": [0, 2, 0], "target": [0, 0, 0], "up": [0, 1, 1e-9]}])"),
              "/lights/0/up");
}

TEST(LoadLight, RefusesAnglesAtTheEndsOfTheirRange) {
    for (const char* angle : {"0", "179", "-10"}) {
        const std::string spot =
            std::string(R"([{"type": "spot", "position": [0, 2, 0], "target": [0, 0, 0], "angle": )") + angle + "}]";
        EXPECT_EQ(place(spot.c_str()), "/lights/0/angle");
    }
}

TEST(LoadLight, NamesAreUnique) {
    EXPECT_EQ(place(R"([{"type": "directional", "direction": [0, -1, 0], "name": "a"},
                        {"type": "directional", "direction": [0, -1, 0], "name": "a"}])"),
              "/lights/1/name");
}

}  // namespace
}  // namespace shadowbench::scene
