// Files as programs write them, read and processed by the whole engine. The visibility behind each is a closed form.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "bench/functions.h"
#include "bench/one_light.h"
#include "bench/run.h"
#include "document/technique_choice.h"
#include "errors.h"

namespace shadowbench::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

const fs::path cases = fs::path(SHADOWBENCH_SOURCE_DIR) / "tests/cases";

RunOptions options() {
    RunOptions options;
    options.data = {cases};
    return options;
}

// Checks the value that every cell of the map stores at `z`, channel after channel.
void expect_everywhere(const json& document, const std::string& technique, float z,
                       const std::vector<double>& visibility, double within) {
    SCOPED_TRACE(technique);
    const OneLight light(document, options(), "");
    const Contender built = light.build(document::read_any_technique(technique), {});
    ASSERT_EQ(built.maps.channels(), visibility.size());
    curves::Curve function;
    for (int y = 0; y < light.layout().height; ++y)
        for (int x = 0; x < light.layout().width; ++x)
            for (std::size_t c = 0; c < visibility.size(); ++c) {
                stored(built.maps, x, y, static_cast<int>(c), {}, function);
                ASSERT_NEAR(curves::evaluate(function, z), visibility[c], within) << x << ", " << y << ", " << c;
            }
}

constexpr float far_away = 1e6f;

json case_document(const char* name) {
    return json::parse(base::read_text(cases / name));
}

// No technique breaks its promise, and `uncompressed` agrees with the truth of the run.
void expect_runs(const json& document) {
    const results::Result result = run(document, options(), {});
    EXPECT_FALSE(results::any_failed(result));
    const results::LightResult& light = result.variants.at(0).lights.at(0);
    EXPECT_GT(light.reference.judged, 0u);
    for (const results::Cell& cell : light.cells) {
        if (cell.technique != "uncompressed") continue;
        EXPECT_LE(cell.lookup.value().norms.max, 1e-3);
    }
}

TEST(FileValues, AVolumeOfThreeVoxelEdges) {
    const json document = case_document("t_nonuni.json");
    expect_everywhere(document, "uncompressed", far_away, {std::exp(-1.6)}, 1e-6);  // 16 voxels of 0.2, density 0.5
    expect_runs(document);
}

TEST(FileValues, AVolumeOfConstantTiles) {
    const json document = case_document("t_tile.json");
    expect_everywhere(document, "uncompressed", far_away, {std::exp(-3.2)}, 1e-6);  // 64 voxels of 1, 0.5 * 0.1
    expect_everywhere(document, "deep:tolerance=0.01", far_away, {std::exp(-3.2)}, 0.01);
    expect_runs(document);
}

TEST(FileValues, TwoHundredFaintLayers) {
    const json document = case_document("t_layers.json");
    for (const char* technique : {"uncompressed", "deep"})
        expect_everywhere(document, technique, far_away, {std::pow(0.995, 200)}, 1e-5);
    expect_runs(document);
}

// Light along -y through a box of density 0.5; the map lies inside the box.
json volume_document(const std::string& file, const std::string& more = "") {
    return json::parse(R"({"name": "volume", "scene": {"objects": [
            {"type": "volume", "file": ")" +
                       file + R"(", "extinction": 0.2)" + more + R"(}]},
        "lights": [{"type": "directional", "direction": [0.3, -1, 0.2], "extent": [2, 2]}],
        "rays": {"resolution": 16, "samples_per_pixel": 1},
        "receivers": {"type": "probes", "count": 500},
        "reference": {"samples_per_pixel": 16, "queries": 64, "spread_seeds": 1},
        "timing": {"repetitions": 1, "lookups": 64},
        "techniques": [{"type": "uncompressed"}]})");
}

TEST(FileValues, VolumesWithoutANameTurnedAndSwapped) {
    // A ray along (0.3, -1, 0.2) passes the top and the bottom: its length is sqrt(1.13) times the height of 16.
    const double visibility = std::exp(-0.2 * 0.5 * 16.0 * std::sqrt(1.13));
    for (const char* file : {"noname.vdb", "rot90.vdb", "yzswap.vdb"}) {
        SCOPED_TRACE(file);
        expect_everywhere(volume_document(file), "uncompressed", far_away, {visibility}, 1e-6);
        json exact = volume_document(file);
        exact["rays"]["media"] = "cells";         // steps have errors, the truth has none
        exact["rays"]["samples_per_pixel"] = 64;  // the box's top lies across the rays: one ray a pixel is noisy
        expect_runs(exact);
    }
    EXPECT_THAT(validate(volume_document("noname.vdb"), options()).notes,
                ElementsAre("/scene/objects/0: the grid \"(no name)\" is read, the only one"));
    EXPECT_TRUE(validate(volume_document("rot90.vdb"), options()).notes.empty());
    expect_everywhere(volume_document("noname.vdb", R"(, "grid": 0)"), "uncompressed", far_away, {visibility}, 1e-6);
    EXPECT_THAT(test::error_of([&] { validate(volume_document("noname.vdb", R"(, "grid": 1)"), options()); },
                               base::ErrorCode::bad_input, "/scene/objects/0/file"),
                HasSubstr("no grid number 1"));
}

TEST(FileValues, AVolumeWithADensityJustBelow0) {
    json document = volume_document("tinyneg.vdb");
    document["lights"][0] = {
        {"type", "directional"}, {"direction", {0, -1, 0}}, {"target", {1, 0, 1}}, {"extent", {1e-3, 1e-3}}};
    // The column of (1, 1, 1) has 0 at one of its 16 voxels, and is linear towards its neighbours.
    expect_everywhere(document, "uncompressed", far_away, {std::exp(-0.2 * 0.5 * 15.0)}, 1e-3);
    document["lights"][0]["target"] = {8, 0, 8};
    expect_everywhere(document, "uncompressed", far_away, {std::exp(-0.2 * 0.5 * 16.0)}, 1e-6);
    EXPECT_THAT(validate(document, options()).notes,
                ElementsAre("/scene/objects/0: 1 of 4096 densities are below 0, the least -1e-06: taken as 0"));
    EXPECT_THAT(
        test::error_of([&] { validate(volume_document("tinyneg.vdb", R"(, "negative": "refuse")"), options()); },
                       base::ErrorCode::bad_input, "/scene/objects/0/file"),
        HasSubstr("-1e-06 is below 0"));
}

json deep_document(const std::string& file, const std::string& more = "") {
    return json::parse(R"({"name": "deep", "scene": {"deep_image": {"file": ")" + file + "\"" + more + R"(}},
        "receivers": {"type": "probes", "count": 500},
        "reference": {"queries": 64},
        "timing": {"repetitions": 1, "lookups": 64},
        "techniques": [{"type": "uncompressed"}, {"type": "deep"}, {"type": "avsm"}, {"type": "fourier"},
                       {"type": "opacity"}, {"type": "shadow_map"}]})");
}

// All three files have alpha 0.5 at Z 3 in each pixel.
void expect_half_at_3(const json& document) {
    for (const char* technique : {"uncompressed", "deep"}) {
        expect_everywhere(document, technique, 3.0f, {1.0}, 0.0);
        expect_everywhere(document, technique, std::nextafter(3.0f, 4.0f), {0.5}, 1e-6);
        expect_everywhere(document, technique, 1e18f, {0.5}, 1e-6);
    }
}

TEST(FileValues, DeepSamplesAtInfinity) {
    const json document = deep_document("inf.exr");
    expect_half_at_3(document);
    expect_runs(document);
    EXPECT_THAT(validate(document, options()).notes, ElementsAre(HasSubstr("64 of 128 samples are at infinity")));
}

TEST(FileValues, DeepSamplesOfALayer) {
    expect_half_at_3(deep_document("layered.exr"));
    expect_half_at_3(deep_document("layered.exr", R"(, "layer": "rgba", "part": 0)"));
    EXPECT_THAT(test::error_of([&] { validate(deep_document("layered.exr", R"(, "layer": "beauty")"), options()); },
                               base::ErrorCode::bad_input, "/scene/deep_image/file"),
                HasSubstr("that have them: rgba"));
    EXPECT_THAT(test::error_of([&] { validate(deep_document("layered.exr", R"(, "part": "right")"), options()); },
                               base::ErrorCode::bad_input, "/scene/deep_image/file"),
                HasSubstr("no such \"part\""));
}

TEST(FileValues, DeepSamplesWithZBack0) {
    const json document = deep_document("zback0.exr");
    expect_half_at_3(document);
    EXPECT_THAT(validate(document, options()).notes,
                ElementsAre("/scene/deep_image: 64 of 64 samples have their ZBack before Z: taken as surfaces"));
}

}  // namespace
}  // namespace shadowbench::bench
