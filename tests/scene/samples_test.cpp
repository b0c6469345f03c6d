// The tiny samples of tests/cases: one at least of each format, read, described, and made a scenario of.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/describe_file.h"
#include "scene/json_text.h"
#include "scene/new_scenario.h"
#include "scene/readers/hair_files.h"
#include "scene/scenario.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

namespace fs = std::filesystem;
using testing::Each;
using testing::ElementsAre;
using testing::StartsWith;

const fs::path folder = fs::path(SHADOWBENCH_SOURCE_DIR) / "tests/cases";

constexpr const char* samples[] = {
    "bom.obj",      "points.ply",  "strips.ply",   "tetra.stl",         "placed.gltf",  "placed.glb",
    "strands.tfx",  "strands.txt", "strands.hair", "mitsuba.hair",      "tile.vdb",     "ramp.nvdb",
    "ramp.pvm",     "ramp.dds",    "ramp.nrrd",    "ramp.nhdr",         "ramp.mha",     "ramp.mhd",
    "ramp.vol",     "ramp.slc",    "scene.pbrt",   "layered.exr",       "leaf.png",     "ramp_4x4x4_float32.raw",
    "ramp_4x4x4_float32.raw.gz"};

DataFile sample(const char* name) {
    return read_data_file(folder / name, {});
}

TEST(Samples, ThereIsOneOfEachFormat) {
    std::set<std::string_view> read, known;
    for (const char* name : samples) read.insert(sample(name).format->title);
    for (const FileFormat& format : file_formats()) known.insert(format.title);
    EXPECT_EQ(read, known);
}

// From any file to a scenario that loads, without a line written by hand.
TEST(Samples, EachIsDescribedAndMakesAScenario) {
    for (const char* name : samples) {
        SCOPED_TRACE(name);
        std::vector<DataFile> files;
        files.push_back(sample(name));
        EXPECT_THAT(describe_file(files[0]), StartsWith((folder / name).string() + ": "));
        const std::vector<std::string> names{name};
        const std::vector<std::string_view> techniques{"deep"};
        const std::string text = in_lines(new_scenario(files, names, techniques, UpAxis::y));
        const Scenario scenario = load_scenario(nlohmann::json::parse(text), {folder});
        if (scenario.scene.deep_image) continue;
        ASSERT_GE(scenario.scene.objects.size(), 2u);
        for (const Object& object : scenario.scene.objects)
            EXPECT_EQ(object.casts_shadow && casts_shadow(object), &object != &scenario.scene.objects.back());
        EXPECT_TRUE(scenario.receivers.camera.has_value());
    }
}

// Two strands of three points, 0.1 wide.
TEST(Samples, StrandsAreTheSameInEveryFormat) {
    for (const char* name : {"strands.tfx", "strands.txt", "strands.hair", "mitsuba.hair"}) {
        SCOPED_TRACE(name);
        const bool has_width = std::string_view(name) == "strands.txt" || std::string_view(name) == "strands.hair";
        const Hair hair = read_strands(folder / name, has_width ? 0.0f : 0.05f).hair;
        EXPECT_THAT(hair.strand_begin, ElementsAre(0u, 3u, 6u));
        EXPECT_THAT(hair.points, ElementsAre(Vec3f(0, 0, 0), Vec3f(0, 1, 0), Vec3f(1, 2, 0), Vec3f(2, 0, 0),
                                             Vec3f(2, 1, 0), Vec3f(2, 2, 1)));
        EXPECT_THAT(hair.radii, Each(0.05f));
    }
}

TEST(Samples, TheBinaryMeshIsThatInText) {
    const DataFile text = sample("placed.gltf"), binary = sample("placed.glb");
    const auto &expected = std::get<Mesh>(text.scene.objects[0].shape),
               &mesh = std::get<Mesh>(binary.scene.objects[0].shape);
    EXPECT_EQ(mesh.positions, expected.positions);
    EXPECT_EQ(mesh.triangles, expected.triangles);
    EXPECT_EQ(mesh.alpha->alpha, expected.alpha->alpha);
}

// A corner of the unit cube: half a unit for each of three sides, and sqrt(3) / 2 for the last.
TEST(Samples, ATetrahedronHasFourCornersAndItsArea) {
    const DataFile file = sample("tetra.stl");
    const auto& mesh = std::get<Mesh>(file.scene.objects[0].shape);
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_NEAR(test::area(mesh), 1.5 + 0.8660254, 1e-6);
}

}  // namespace
}  // namespace shadowbench::scene
