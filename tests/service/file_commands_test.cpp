// inspect and new, on small files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "service/run_cli.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string case_file(const std::string& name) {
    return (fs::path(SHADOWBENCH_SOURCE_DIR) / "tests/cases" / name).string();
}

class FileCommands : public ::testing::Test {
protected:
    std::string path(const std::string& name) const { return temporary_.path(name); }
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path(name), std::ios::binary) << text;
        return path(name);
    }
    nlohmann::json read(const std::string& name) const { return nlohmann::json::parse(base::read_text(path(name))); }

    // One line on standard error that says this, nothing on standard output.
    void fails(const std::vector<std::string>& arguments, int code, const std::string& says) const {
        const Outcome outcome = cli(arguments);
        EXPECT_EQ(outcome.code, code) << outcome.err;
        EXPECT_EQ(outcome.out, "");
        EXPECT_THAT(outcome.err, AllOf(StartsWith("shadowbench: "), HasSubstr(says)));
        EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
    }

    const TemporaryFolder temporary_;
};

std::vector<std::string> types_in(const nlohmann::json& scenario) {
    std::vector<std::string> types;
    for (const nlohmann::json& technique : scenario.at("techniques"))
        types.push_back(technique.at("type").get<std::string>());
    return types;
}

TEST_F(FileCommands, InspectDescribesEachFileAndWhatLoadsIt) {
    const Outcome outcome = cli({"inspect", case_file("edge.obj"), case_file("noname.vdb"), case_file("zback0.exr")});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    for (const char* text :
         {"edge.obj: Wavefront OBJ mesh", "4 vertices, 2 triangles",
          "note: passed over: faces of fewer than 3 corners (1)",
          "  object: {\"type\": \"mesh\", \"name\": \"edge\", \"file\": ", "OpenVDB grid", "4096 active voxels",
          "\"extinction\": 0.25}\n", "deep OpenEXR image", "64 samples", "  deep_image: {\"file\": "})
        EXPECT_THAT(outcome.out, HasSubstr(text));
}

TEST_F(FileCommands, InspectReadsAPointCloudAsParticles) {
    const Outcome outcome = cli({"inspect", case_file("points.ply")});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("PLY point cloud"), HasSubstr("object: {\"type\": \"particles\"")));
}

TEST_F(FileCommands, InspectReadsTheGridPartAndLayerAskedFor) {
    const Outcome grid = cli({"inspect", case_file("noname.vdb"), "--grid", "0"});
    EXPECT_THAT(grid.out, HasSubstr("\"grid\": 0")) << grid.err;
    fails({"inspect", case_file("noname.vdb"), "--grid", "heat"}, 65, "there is no grid \"heat\"");
    const Outcome layer = cli({"inspect", case_file("layered.exr"), "--layer", "rgba", "--part", "0"});
    EXPECT_THAT(layer.out, HasSubstr("\"layer\": \"rgba\", \"part\": 0}")) << layer.err;
    fails({"inspect", case_file("layered.exr"), "--layer", "beauty"}, 65, "there is no layer \"beauty\"");
}

TEST_F(FileCommands, RefuseFilesWithTheirPlace) {
    for (const std::string command : {"inspect", "new"}) {
        fails({command}, 64, "FILE");
        fails({command, path("gone.obj")}, 66, "gone.obj: there is no such file");
        fails({command, write("a.xyz", "1 2 3\n")}, 65, "a.xyz: the name of a data file must end in .obj, ");
        fails({command, write("b.obj", "v 0 0 0\nv 1 zero 0\n")}, 65, "b.obj:2");
    }
    fails({"new", case_file("inf.exr"), case_file("bom.obj")}, 64, "inf.exr: a deep image is a scene of its own");
    fails({"new", case_file("bom.obj"), "--up", "x"}, 64, "--up");
    const std::string mesh = write("c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n");
    fails({"new", mesh, "--out", path("./c.obj")}, 64, "this is one of the data files");
    fails({"new", case_file("bom.obj"), "--out", write("file", "") + "/a.json"}, 74,
          path("file") + ": cannot make the folder");
}

TEST_F(FileCommands, WhatNewMakesIsValid) {
    struct Made {
        const char *file, *valid;
    };
    for (const Made& made : {Made{"bom.obj", "OK bom: 1 variant of 1 light and 7 techniques\n"},
                             Made{"strips.ply", "OK strips: 1 variant of 1 light and 7 techniques\n"},
                             Made{"placed.gltf", "OK placed: 1 variant of 1 light and 7 techniques\n"},
                             Made{"noname.vdb", "OK noname: 1 variant of 1 light and 7 techniques\n"},
                             Made{"tile.vdb", "OK tile: 1 variant of 1 light and 7 techniques\n"},
                             Made{"zback0.exr", "OK zback0: 1 variant of 1 light and 6 techniques\n"},
                             Made{"inf.exr", "OK inf: 1 variant of 1 light and 6 techniques\n"}}) {
        const Outcome written = cli({"new", case_file(made.file), "--out", path("made.json"), "--force"});
        ASSERT_EQ(written.code, 0) << written.err;
        EXPECT_EQ(written.out, "written: " + path("made.json") + "\n");
        const Outcome valid = cli({"validate", path("made.json")});
        EXPECT_EQ(valid.code, 0) << valid.err;
        EXPECT_THAT(valid.out, StartsWith(made.valid));
    }
}

TEST_F(FileCommands, NewTakesTechniquesThatFit) {
    cli({"new", case_file("bom.obj"), "--out", path("mesh.json")});
    EXPECT_THAT(types_in(read("mesh.json")),
                ElementsAre("shadow_map", "pcf", "deep", "multi_depth", "avsm", "uncompressed", "ray_traced"));
    cli({"new", case_file("noname.vdb"), "--out", path("smoke.json")});
    EXPECT_THAT(types_in(read("smoke.json")),
                ElementsAre("deep", "volume_deep", "avsm", "opacity", "fourier", "uncompressed", "ray_traced"));
    cli({"new", case_file("inf.exr"), "--out", path("deep.json")});
    EXPECT_THAT(types_in(read("deep.json")),
                ElementsAre("deep", "volume_deep", "avsm", "opacity", "fourier", "uncompressed"));
}

// The scenario can move with its folder; a file that lies elsewhere keeps its place.
TEST_F(FileCommands, NewNamesFilesRelativeToTheScenario) {
    fs::create_directory(path("scene"));
    fs::create_directory(path("scene/meshes"));
    const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n";
    const std::string inside = write("scene/meshes/a.obj", mesh), outside = write("b.obj", mesh);
    ASSERT_EQ(cli({"new", inside, outside, "--out", path("scene/made.json")}).code, 0);
    const nlohmann::json objects = read("scene/made.json").at("scene").at("objects");
    EXPECT_EQ(objects.at(0).at("file"), "meshes/a.obj");
    EXPECT_EQ(objects.at(1).at("file"), outside);
    EXPECT_EQ(cli({"validate", path("scene/made.json")}).code, 0);
}

// Otherwise a scenario that was edited by hand is lost.
TEST_F(FileCommands, NewWritesOverNothingUnlessItIsForcedTo) {
    const std::string mine = write("mine.json", "{\"mine\": true}");
    fails({"new", case_file("bom.obj"), "--out", mine}, 64, "the file exists; choose another name, or give --force");
    EXPECT_EQ(read("mine.json").at("mine"), true);
    EXPECT_EQ(cli({"new", case_file("bom.obj"), "--out", mine, "--force"}).code, 0);
    EXPECT_EQ(read("mine.json").at("name"), "bom");
}

TEST_F(FileCommands, FaultsOfWritingNameTheFileAskedFor) {
    fails({"new", case_file("bom.obj"), "--out", "/proc/made.json"}, 74, "/proc/made.json: cannot write the file");
}

TEST_F(FileCommands, ADataFileInPlaceOfAScenarioIsAnsweredWithTheCommandForIt) {
    for (const std::string command : {"run", "validate"})
        fails({command, case_file("bom.obj")}, 65,
              "this is a data file (Wavefront OBJ mesh); make a scenario around it: shadowbench new ");
}

TEST_F(FileCommands, NewPrintsTheScenarioWithoutAFile) {
    const Outcome outcome = cli({"new", case_file("bom.obj"), "--up", "z"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const nlohmann::json scenario = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(scenario.at("name"), "bom");
    EXPECT_EQ(scenario.at("scene").at("objects").at(0).at("file"), case_file("bom.obj"));
    EXPECT_EQ(scenario.at("receivers").at("up"), nlohmann::json({0, 0, 1}));
}

// From the first file to a result, without a line written by hand.
TEST_F(FileCommands, WhatNewMakesRuns) {
    const std::string mesh = write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n");
    ASSERT_EQ(cli({"new", mesh, "--out", path("made.json")}).code, 0);
    const Outcome run =
        cli({"run", path("made.json"), "--out", path("results"), "--only", "deep", "--set", "rays.resolution=16",
             "--set", "receivers.resolution=[32,24]", "--set", "reference.samples_per_pixel=16", "--set",
             "reference.queries=50", "--set", "timing.repetitions=1", "--set", "timing.lookups=64"});
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_TRUE(fs::exists(path("results/result.json")));
    EXPECT_THAT(run.out, Not(HasSubstr("the light sees nothing")));
}

}  // namespace
}  // namespace shadowbench::service
