#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include <nlohmann/json.hpp>

#include "scene/file_lines.h"
#include "scene/scenario.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using nlohmann::json;
using test::error_of;
using testing::HasSubstr;

json minimal() {
    return json::parse(R"({
        "name": "minimal",
        "scene": {"objects": [{"type": "sphere", "centre": [0, 0, 0], "radius": 1}]},
        "lights": [{"type": "directional", "direction": [0, -2, 0]}],
        "techniques": [{"type": "avsm", "nodes": 8}]
    })");
}

base::Error error_with(const char* pointer, const char* value, const json& base = minimal()) {
    json document = base;
    document[json::json_pointer(pointer)] = json::parse(value);
    return error_of([&] { load_scenario(document, {}); });
}

void expect_same(const RaySettings& a, const RaySettings& b) {
    EXPECT_EQ(a.resolution, b.resolution);
    EXPECT_EQ(a.samples_per_pixel, b.samples_per_pixel);
    EXPECT_EQ(a.pattern, b.pattern);
    EXPECT_EQ(a.media, b.media);
    EXPECT_EQ(a.seed, b.seed);
}

void expect_same(const Receivers& a, const Receivers& b) {
    EXPECT_EQ(a.camera.has_value(), b.camera.has_value());
    EXPECT_EQ(a.resolution, b.resolution);
    EXPECT_EQ(a.media_lookups, b.media_lookups);
    EXPECT_EQ(a.count, b.count);
    EXPECT_EQ(a.seed, b.seed);
    EXPECT_TRUE(a.filter_width == b.filter_width);
    EXPECT_EQ(a.bias, b.bias);
}

void expect_same(const Reference& a, const Reference& b) {
    EXPECT_EQ(a.samples_per_pixel, b.samples_per_pixel);
    EXPECT_EQ(a.queries, b.queries);
    EXPECT_EQ(a.spread_seeds, b.spread_seeds);
    EXPECT_EQ(a.seed, b.seed);
}

void expect_same(const Timing& a, const Timing& b) {
    EXPECT_EQ(a.repetitions, b.repetitions);
    EXPECT_EQ(a.most_repetitions, b.most_repetitions);
    EXPECT_EQ(a.goal, b.goal);
    EXPECT_EQ(a.seconds, b.seconds);
    EXPECT_EQ(a.lookups, b.lookups);
}

// Every key of a section of the schema that has a default, with that default.
json defaults_of(const json& section) {
    json values = json::object();
    for (const auto& [name, property] : section["properties"].items())
        if (property.contains("default")) values[name] = property["default"];
    return values;
}

TEST(LoadScenario, DefaultsAreThoseOfTheStructs) {
    const Scenario scenario = load_scenario(minimal(), {});
    expect_same(scenario.rays, RaySettings{});
    expect_same(scenario.receivers, Receivers{});
    expect_same(scenario.reference, Reference{});
    expect_same(scenario.timing, Timing{});
    EXPECT_EQ(scenario.purpose, "");
    EXPECT_TRUE(scenario.scene.objects[0].casts_shadow);
    EXPECT_EQ(scenario.scene.objects[0].opacity, Vec3f(1, 1, 1));
    EXPECT_EQ(scenario.lights[0].colour, Vec3f(1, 1, 1));
}

TEST(LoadScenario, DefaultsAreThoseThatTheSchemaDocuments) {
    const json& properties = scenario_schema()["properties"];
    const json& definitions = scenario_schema()["definitions"];
    json document = minimal();
    for (const char* section : {"rays", "reference", "timing"}) {
        document[section] = defaults_of(properties[section]);
        EXPECT_EQ(document[section].size(), properties[section]["properties"].size()) << section;
    }
    document["receivers"] = defaults_of(definitions["probes"]);
    document["receivers"]["type"] = properties["receivers"]["default"]["type"];
    const Scenario written = load_scenario(document, {});
    expect_same(written.rays, RaySettings{});
    expect_same(written.receivers, Receivers{});
    expect_same(written.reference, Reference{});
    expect_same(written.timing, Timing{});

    document["receivers"] = defaults_of(definitions["camera"]);
    document["receivers"].update(json{{"type", "camera"}, {"position", {0, 0, 5}}, {"target", {0, 0, 0}}});
    const Receivers camera = load_scenario(document, {}).receivers;
    EXPECT_EQ(camera.resolution, Receivers{}.resolution);
    EXPECT_EQ(camera.media_lookups, Receivers{}.media_lookups);
    EXPECT_EQ(camera.camera->fov, Camera{}.fov);
    EXPECT_EQ(camera.camera->up, Camera{}.up);
}

TEST(LoadScenario, ReadsEverySetting) {
    json document = minimal();
    document["purpose"] = "To see.";
    document["rays"] = {{"resolution", {64, 32}},
                        {"samples_per_pixel", 9},
                        {"pattern", "regular"},
                        {"media", "cells"},
                        {"seed", 9007199254740991}};
    document["receivers"] = {
        {"type", "camera"},    {"position", {1, 2, 3}}, {"target", {0, 1, 0}}, {"up", {0, 0, 1}},
        {"fov", 60},           {"resolution", 100},     {"media_lookups", 3},  {"seed", 4},
        {"filter_width", 2.5}, {"bias", 0.25},          {"slope_bias", 0.5},   {"normal_bias", 1.5}};
    document["reference"] = {{"samples_per_pixel", 10}, {"queries", 11}, {"spread_seeds", 12}, {"seed", 13}};
    document["timing"] = {
        {"repetitions", 14}, {"most_repetitions", 16}, {"goal", 0.25}, {"seconds", 17.5}, {"lookups", 15}};
    const Scenario scenario = load_scenario(document, {});
    EXPECT_EQ(scenario.name, "minimal");
    EXPECT_EQ(scenario.purpose, "To see.");
    expect_same(scenario.rays, RaySettings{{64, 32}, 9, Pattern::regular, Media::cells, 9007199254740991});
    EXPECT_EQ(scenario.receivers.camera->position, Vec3d(1, 2, 3));
    EXPECT_EQ(scenario.receivers.camera->target, Vec3d(0, 1, 0));
    EXPECT_EQ(scenario.receivers.camera->up, Vec3d(0, 0, 1));
    EXPECT_EQ(scenario.receivers.camera->fov, 60.0);
    EXPECT_EQ(scenario.receivers.resolution, Vec2i(100, 100));
    EXPECT_EQ(scenario.receivers.media_lookups, 3);
    EXPECT_EQ(scenario.receivers.seed, 4u);
    EXPECT_TRUE((scenario.receivers.filter_width == FilterWidth{WidthUnit::map_pixels, 2.5}));
    EXPECT_EQ(scenario.receivers.bias, 0.25);
    EXPECT_EQ(scenario.receivers.slope_bias, 0.5);
    EXPECT_EQ(scenario.receivers.normal_bias, 1.5);
    expect_same(scenario.reference, Reference{10, 11, 12, 13});
    expect_same(scenario.timing, Timing{14, 16, 0.25, 17.5, 15});
}

TEST(LoadScenario, TheMostRepetitionsFollowTheLeast) {
    const auto most = [](int repetitions) {
        json document = minimal();
        document["timing"] = {{"repetitions", repetitions}};
        return load_scenario(document, {}).timing.most_repetitions;
    };
    EXPECT_EQ(most(1), 1) << "a scenario that does not care for times";
    EXPECT_EQ(most(4), 4);
    EXPECT_EQ(most(5), 31);
    EXPECT_EQ(most(31), 31);
    EXPECT_EQ(most(100), 100);
    const base::Error error = error_with("/timing", R"({"repetitions": 9, "most_repetitions": 8})");
    EXPECT_EQ(error.where(), "/timing/most_repetitions");
    EXPECT_THAT(error.message(), HasSubstr("at least repetitions, 9"));
    EXPECT_EQ(error_with("/timing", R"({"goal": 0})").where(), "/timing/goal");
}

TEST(LoadScenario, ReadsPointsThatReceiveLight) {
    json document = minimal();
    document["receivers"] = {{"type", "points"},
                             {"positions", {{1, 2.125, 3}, {-1e18, 0.1, 5e-324}}},
                             {"seed", 4},
                             {"filter_width", 2.5},
                             {"bias", 0.25}};
    const Receivers receivers = load_scenario(document, {}).receivers;
    EXPECT_FALSE(receivers.camera);
    EXPECT_EQ(receivers.points, (std::vector<Vec3d>{{1, 2.125, 3}, {-1e18, 0.1, 5e-324}})) << "not rounded to float";
    EXPECT_EQ(receivers.seed, 4u);
    EXPECT_TRUE((receivers.filter_width == FilterWidth{WidthUnit::map_pixels, 2.5}));
    EXPECT_EQ(receivers.bias, 0.25);

    document["receivers"] = defaults_of(scenario_schema()["definitions"]["points"]);
    document["receivers"].update(json{{"type", "points"}, {"positions", {{0, 0, 0}}}});
    expect_same(load_scenario(document, {}).receivers, Receivers{});
}

json camera_with(const json& more) {
    json document = minimal();
    document["receivers"] = {{"type", "camera"}, {"position", {1, 2, 3}}, {"target", {0, 1, 0}}};
    document["receivers"].update(more);
    return document;
}

TEST(LoadScenario, ReadsTheFootprintInItsUnit) {
    const std::pair<const char*, WidthUnit> units[] = {{"map_pixels", WidthUnit::map_pixels},
                                                       {"share", WidthUnit::share},
                                                       {"length", WidthUnit::length},
                                                       {"receiver_pixels", WidthUnit::receiver_pixels}};
    for (const auto& [name, unit] : units) {
        const Receivers receivers = load_scenario(camera_with({{"footprint", {{name, 0.5}}}}), {}).receivers;
        EXPECT_TRUE((receivers.filter_width == FilterWidth{unit, 0.5})) << name;
    }
}

TEST(LoadScenario, RefusesFootprintsThatAreNotOneWidth) {
    const auto place = [](const json& document) {
        try {
            load_scenario(document, {});
        } catch (const base::Error& error) {
            return error.where() + ": " + error.message();
        }
        return std::string("loaded");
    };
    using ::testing::AllOf, ::testing::HasSubstr, ::testing::StartsWith;
    EXPECT_THAT(place(camera_with({{"filter_width", 2}, {"footprint", {{"length", 1}}}})),
                AllOf(StartsWith("/receivers/filter_width: "), HasSubstr("given twice")));
    EXPECT_THAT(place(camera_with({{"footprint", {{"length", 1}, {"share", 0.5}}}})),
                StartsWith("/receivers/footprint: "));
    EXPECT_THAT(place(camera_with({{"footprint", json::object()}})), StartsWith("/receivers/footprint: "));
    EXPECT_THAT(place(camera_with({{"footprint", {{"lenght", 1}}}})), HasSubstr("lenght"));
    EXPECT_THAT(place(camera_with({{"footprint", {{"share", 1.5}}}})), StartsWith("/receivers/footprint/share: "));
    json probes = minimal();
    probes["receivers"] = {{"type", "probes"}, {"footprint", {{"receiver_pixels", 1}}}};
    EXPECT_THAT(place(probes), AllOf(StartsWith("/receivers/footprint/receiver_pixels: "), HasSubstr("length")));
}

TEST(LoadScenario, RefusesPointsThatAreNone) {
    EXPECT_EQ(error_with("/receivers", R"({"type": "points"})").where(), "/receivers");
    EXPECT_EQ(error_with("/receivers", R"({"type": "points", "positions": []})").where(), "/receivers/positions");
    EXPECT_EQ(error_with("/receivers", R"({"type": "points", "positions": [[0, 0, 0], [0, 1e19, 0]]})").where(),
              "/receivers/positions/1/1");
    EXPECT_EQ(error_with("/receivers", R"({"type": "probes", "positions": [[0, 0, 0]]})").where(),
              "/receivers/positions");
}

TEST(LoadScenario, HandsTechniquesTheirParametersUnread) {
    const Scenario scenario = load_scenario(minimal(), {});
    ASSERT_EQ(scenario.techniques.size(), 1u);
    EXPECT_EQ(scenario.techniques[0].type, "avsm");
    EXPECT_EQ(scenario.techniques[0].parameters, R"({"nodes":8})");
    EXPECT_EQ(scenario.techniques[0].where, "/techniques/0");
}

TEST(LoadScenario, IgnoresSweeps) {
    json document = minimal();
    document["sweeps"] = {{"/rays/seed", {1, 2}}};
    EXPECT_NO_THROW(load_scenario(document, {}));
}

TEST(LoadScenario, RefusesAnEmptyScene) {
    EXPECT_EQ(error_with("/scene", "{}").where(), "/scene");
    EXPECT_THAT(error_with("/scene", "{}").message(), HasSubstr("empty"));
    EXPECT_EQ(error_with("/scene/objects/0/casts_shadow", "false").where(), "/scene/objects");
    EXPECT_THAT(error_with("/scene/deep_image", R"({"file": "a.exr"})").message(), HasSubstr("not both"));
    EXPECT_EQ(error_with("/lights", "[]").where(), "/lights");
}

TEST(LoadScenario, StatesTheLimitOfLightRays) {
    const base::Error error = error_with("/rays", R"({"resolution": 16384, "samples_per_pixel": 17})");
    EXPECT_EQ(error.where(), "/rays");
    EXPECT_THAT(error.message(), HasSubstr("limit is 4294967296"));
    EXPECT_THAT(error_with("/reference", R"({"samples_per_pixel": 65536, "queries": 65537})").message(),
                HasSubstr("limit"));
    EXPECT_THAT(error_with("/receivers", R"({"type": "camera", "position": [0, 0, 5], "target": [0, 0, 0],
                           "resolution": 16384})")
                    .message(),
                HasSubstr("limit"));
}

TEST(LoadScenario, RefusesNumbersThatAreNoneOrOfAnotherKindAtTheirPlace) {
    // As a whole number, as a number and as a number in a list.
    for (const char* value : {"\"4\"", "null", "true", "1e300", "-1e300", "[1]", "1e19", "18446744073709551615"})
        for (const char* place : {"/rays/samples_per_pixel", "/rays/seed", "/reference/queries", "/timing/lookups",
                                  "/scene/objects/0/radius", "/scene/objects/0/centre/1", "/lights/0/direction/2"}) {
            json document = minimal();
            document["rays"] = {{"samples_per_pixel", 4}, {"seed", 1}};
            document["reference"] = {{"queries", 1}};
            document["timing"] = {{"lookups", 1}};
            const base::Error error = error_with(place, value, document);
            EXPECT_EQ(error.code(), base::ErrorCode::bad_input) << place << " " << value;
            EXPECT_EQ(error.where(), place) << value;
        }
    for (const char* value : {"4.5", "4e30", "9223372036854775808", "99999999999999999999"})
        EXPECT_EQ(error_with("/rays", (std::string(R"({"samples_per_pixel": )") + value + "}").c_str()).where(),
                  "/rays/samples_per_pixel");
}

TEST(LoadScenario, StatesTheLimitsOfPlacesInMediaAndOfMarching) {
    const base::Error places = error_with(
        "/receivers", R"({"type": "camera", "position": [0, 0, 5], "target": [0, 0, 0], "media_lookups": 4096})");
    EXPECT_NO_THROW(load_scenario(minimal(), {}));
    EXPECT_EQ(places.where(), "/receivers/media_lookups");
    EXPECT_THAT(places.message(), HasSubstr("limit is 268435456"));

    json document = minimal();
    document["scene"]["objects"] = {{{"type", "density_box"}, {"size", {2, 2, 2}}, {"step", 4e-6}}};
    document["rays"] = {{"resolution", 1}, {"samples_per_pixel", 4}};
    document["reference"] = {{"queries", 1}, {"samples_per_pixel", 4}};
    EXPECT_NO_THROW(load_scenario(document, {})) << "a million steps";
    EXPECT_EQ(error_with("/rays/resolution", "16384", document).where(), "/rays");
    document["reference"]["queries"] = 16777216;
    EXPECT_NO_THROW(load_scenario(document, {})) << "the truth takes no steps";
    const base::Error step = error_with("/scene/objects/0/step", "1e-18", document);
    EXPECT_EQ(step.where(), "/scene/objects/0/step");
    EXPECT_THAT(step.message(), HasSubstr("make it at least 3.46e-07"));

    document["scene"]["objects"] = {{{"type", "density_box"}, {"size", {1, 1, 4096}}}};
    document["reference"] = {{"queries", 1}, {"samples_per_pixel", 256}};
    EXPECT_NO_THROW(load_scenario(document, {}));
    const base::Error cells = error_with("/reference/queries", "16777216", document);
    EXPECT_EQ(cells.where(), "/reference");
    EXPECT_THAT(cells.message(), HasSubstr("fewer voxels"));
}

TEST(LoadScenario, GridVolumesAreMarchedInStepsUnlessCellsAreAskedFor) {
    json document = minimal();
    EXPECT_EQ(load_scenario(document, {}).rays.media, Media::steps);
    document["rays"] = {{"media", "cells"}};
    EXPECT_EQ(load_scenario(document, {}).rays.media, Media::cells);
    EXPECT_EQ(error_with("/rays/media", "\"voxels\"", document).where(), "/rays/media");
}

TEST(LoadScenario, RefusesCamerasThatSeeNothing) {
    const char* on_target = R"({"type": "camera", "position": [0, 0, 5], "target": [0, 0, 5]})";
    EXPECT_EQ(error_with("/receivers", on_target).where(), "/receivers/target");
    const char* along = R"({"type": "camera", "position": [0, 5, 0], "target": [0, 0, 0]})";
    EXPECT_EQ(error_with("/receivers", along).where(), "/receivers/up");
    const char* no_up = R"({"type": "camera", "position": [5, 0, 0], "target": [0, 0, 0], "up": [0, 0, 0]})";
    EXPECT_EQ(error_with("/receivers", no_up).where(), "/receivers/up");
}

json deep() {
    return json::parse(R"({"name": "deep", "scene": {"deep_image": {"file": "deep/leaves.exr"}},
                           "techniques": [{"type": "deep"}]})");
}

TEST(LoadScenario, ADeepImageBringsItsOwnLightAndRays) {
    SHADOWBENCH_NEED_DATA(file, "deep/leaves.exr");
    json document = deep();
    document["rays"] = {{"resolution", 8}, {"samples_per_pixel", 4}};
    const Scenario scenario = load_scenario(document, {file.parent_path().parent_path()});
    ASSERT_TRUE(scenario.scene.deep_image);
    ASSERT_EQ(scenario.lights.size(), 1u);
    EXPECT_EQ(scenario.lights[0].name, "deep_image");
    EXPECT_EQ(scenario.lights[0].type, LightType::deep_image);
    EXPECT_EQ(scenario.rays.resolution, Vec2i(1024, 576));
    EXPECT_EQ(scenario.rays.samples_per_pixel, 1);
    EXPECT_EQ(scenario.rays.pattern, Pattern::regular);
}

TEST(FileLines, TellsTheCountsRangeAndBoxOfEachFile) {
    const std::filesystem::path cases = std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "tests/cases";
    json document = minimal();
    json& objects = document["scene"]["objects"];
    objects.push_back({{"type", "volume"}, {"file", "ramp.nvdb"}, {"motion", {9, 9, 9}}});
    objects.push_back({{"type", "volume"}, {"file", "tinyneg.vdb"}, {"negative", "clamp"}});
    objects.push_back({{"type", "mesh"}, {"file", "strips.ply"}});
    const auto lines_of = [&] { return file_lines(document, load_scenario(document, {cases}).scene); };
    EXPECT_THAT(lines_of(),
                testing::ElementsAre("/scene/objects/1/file: ramp.nvdb: 4 x 4 x 4 voxels, density 0 to "
                                     "0.984375; box [0, 0, 0] to [4, 8, 2]",
                                     "/scene/objects/2/file: tinyneg.vdb: 16 x 16 x 16 voxels, density 0 to "
                                     "0.5; box [-0.5, -0.5, -0.5] to [15.5, 15.5, 15.5]",
                                     HasSubstr("/scene/objects/3/file: strips.ply: ")));
    document["scene"] = {{"deep_image", {{"file", "zback0.exr"}}}};
    document.erase("lights");
    EXPECT_THAT(lines_of(), testing::ElementsAre("/scene/deep_image/file: zback0.exr: 8 x 8 pixels, 64 samples, Z 3"));
    EXPECT_TRUE(file_lines(minimal(), load_scenario(minimal(), {}).scene).empty());
}

TEST(LoadScenario, ADeepImageHasNoOtherLightsAndNoCamera) {
    EXPECT_EQ(error_with("/lights", R"([{"type": "directional", "direction": [0, -1, 0]}])", deep()).where(),
              "/lights");
    EXPECT_EQ(
        error_with("/receivers", R"({"type": "camera", "position": [0, 0, 5], "target": [0, 0, 0]})", deep()).where(),
        "/receivers/type");
    EXPECT_EQ(error_with("/receivers", R"({"type": "points", "positions": [[0, 0, 5]]})", deep()).where(),
              "/receivers/type");
    const base::Error missing = error_of([] { load_scenario(deep(), {"/nowhere"}); });
    EXPECT_EQ(missing.code(), base::ErrorCode::no_such_file);
    EXPECT_EQ(missing.where(), "/scene/deep_image/file");
}

}  // namespace
}  // namespace shadowbench::scene
