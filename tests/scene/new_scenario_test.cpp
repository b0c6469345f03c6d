// Scenarios around data files load, and have what the files ask for.
#include <OpenImageIO/imageio.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/json_text.h"
#include "scene/new_scenario.h"
#include "scene/scenario.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using nlohmann::ordered_json;
using test::error_of;
using testing::HasSubstr;

std::filesystem::path case_file(const std::string& name) {
    return std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "tests/cases" / name;
}

// Around files in one folder, by their names there.
ordered_json made_from(const std::vector<std::filesystem::path>& paths, UpAxis up = UpAxis::y) {
    std::vector<DataFile> files;
    std::vector<std::string> names;
    for (const std::filesystem::path& path : paths) {
        files.push_back(read_data_file(path, {}));
        names.push_back(path.filename().string());
    }
    const std::vector<std::string_view> techniques{"deep", "avsm"};
    return new_scenario(files, names, techniques, up);
}

Scenario loaded(const ordered_json& scenario, const std::filesystem::path& folder) {
    return load_scenario(nlohmann::json::parse(in_lines(scenario)), {folder});
}

TEST(NewScenario, OfEachKindOfFileLoads) {
    for (const char* name : {"bom.obj", "edge.obj", "strips.ply", "points.ply", "placed.gltf", "noname.vdb",
                             "rot90.vdb", "tinyneg.vdb", "zback0.exr", "inf.exr", "layered.exr"}) {
        SCOPED_TRACE(name);
        const Scenario scenario = loaded(made_from({case_file(name)}), case_file(name).parent_path());
        EXPECT_EQ(scenario.name, std::string(name).substr(0, std::string(name).find('.')));
        EXPECT_EQ(scenario.techniques.size(), 2u);
        EXPECT_EQ(scenario.lights.size(), 1u);
        if (scenario.scene.deep_image) continue;
        ASSERT_EQ(scenario.scene.objects.size(), 2u);
        EXPECT_TRUE(scenario.scene.objects[0].casts_shadow);
        EXPECT_FALSE(scenario.scene.objects[1].casts_shadow) << "the ground would darken the map";
        EXPECT_TRUE(scenario.receivers.camera.has_value());
        EXPECT_GT(scenario.receivers.bias, 0.0);
    }
}

struct Dense {
    const char* file;
    double edge, voxels, density;
};

// Any other extinction makes a cloud of smoke that is a wall, or nothing at all.
TEST(NewScenario, TheDensestColumnOfAVolumeHasAnOpticalDepthOf2) {
    for (const Dense& dense :
         {Dense{"noname.vdb", 1.0, 16, 0.5}, Dense{"tile.vdb", 1.0, 64, 0.5}, Dense{"nonuniform.vdb", 0.1, 16, 0.5}}) {
        const Scenario scenario = loaded(made_from({case_file(dense.file)}), case_file(dense.file).parent_path());
        const double depth = scenario.scene.objects[0].extinction.x * dense.edge * dense.voxels * dense.density;
        EXPECT_NEAR(depth, 2.0, 0.1) << dense.file;  // two digits
    }
}

TEST(NewScenario, APastedObjectLoadsWhatWasRead) {
    std::string bytes(24, '\0');
    bytes[5] = '\xff';
    const auto file = test::write_file("ball_2x3x4.raw", bytes);
    const ordered_json object = scene_objects(read_data_file(file, {}), "ball_2x3x4.raw").at(0);
    EXPECT_EQ(in_one_line(object),
              R"({"type": "volume", "name": "ball_2x3x4", "file": "ball_2x3x4.raw", "format": "uint8", )"
              R"("size": [2, 3, 4], "lower": [0, 0, 0], "upper": [2, 3, 4], "extinction": 2})");
    FileChoice choice;
    choice.deep.layer = "rgba";
    choice.deep.part = 0;
    EXPECT_EQ(in_one_line(scene_objects(read_data_file(case_file("layered.exr"), choice), "a.exr").at(0)),
              R"({"file": "a.exr", "layer": "rgba", "part": 0})");
}

// Its own extinction, so that no factor is made up.
TEST(NewScenario, APbrtSceneIsAnObjectOfEachType) {
    const std::vector<ordered_json> made = scene_objects(read_data_file(case_file("scene.pbrt"), {}), "s.pbrt");
    ASSERT_EQ(made.size(), 4u);
    EXPECT_EQ(in_one_line(made[0]), R"({"type": "hair", "name": "scene_hair", "file": "s.pbrt", "opacity": 0.6})");
    EXPECT_EQ(in_one_line(made[1]), R"({"type": "particles", "name": "scene_particles", "file": "s.pbrt"})");
    EXPECT_EQ(in_one_line(made[2]), R"({"type": "volume", "name": "scene_smoke", "file": "s.pbrt", "grid": "smoke"})");
    EXPECT_EQ(in_one_line(made[3]), R"({"type": "mesh", "name": "scene_mesh", "file": "s.pbrt"})");
    // Media of the same name are told apart by their numbers.
    const std::string box =
        "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1] \"integer indices\" "
        "[0 1 2 1 2 3 4 5 6 5 6 7 0 1 4 1 4 5 2 3 6 3 6 7 0 2 4 2 4 6 1 3 5 3 5 7]\n";
    const auto two = test::write_file("two.pbrt",
                                      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"
                                      "MediumInterface \"fog\" \"\" Material \"interface\"\n" +
                                          box + "Translate 2 0 0\n" + box);
    const std::vector<ordered_json> fogs = scene_objects(read_data_file(two, {}), "two.pbrt");
    ASSERT_EQ(fogs.size(), 2u);
    EXPECT_EQ(fogs[0]["grid"], 0);
    EXPECT_EQ(fogs[1]["grid"], 1);
    const Scenario foggy = loaded(made_from({two}), two.parent_path());
    EXPECT_EQ(std::get<GridVolume>(foggy.scene.objects[1].shape).lower, Vec3d(2, 0, 0));
    const Scenario scenario = loaded(made_from({case_file("scene.pbrt")}), case_file("scene.pbrt").parent_path());
    ASSERT_EQ(scenario.scene.objects.size(), 5u);
    EXPECT_EQ(std::get<GridVolume>(scenario.scene.objects[2].shape).density.back(), 12.0f);
}

// Without the guess, a cloud of points casts no shadow at all; with another extinction, its points are walls or
// nothing.
TEST(NewScenario, PointsHaveARadiusAndAnOpticalDepthOf2) {
    EXPECT_EQ(in_one_line(scene_objects(read_data_file(case_file("points.ply"), {}), "points.ply").at(0)),
              R"({"type": "particles", "name": "points", "file": "points.ply", "radius": 0.4, "extinction": 2.5})");
    const Scenario scenario = loaded(made_from({case_file("points.ply")}), case_file("points.ply").parent_path());
    const auto& points = std::get<Particles>(scenario.scene.objects[0].shape);
    EXPECT_EQ(points.radii, std::vector<float>(4, 0.4f));
    EXPECT_EQ(points.centres[2], Vec3f(1, 1, -1));
}

TEST(NewScenario, AVolumeKeepsTheBoxOfItsFile) {
    const auto file = test::write_file("a.mha",
                                       "NDims = 3\nDimSize = 1 1 1\nOffset = 1 2 3\nElementSpacing = 2 2 2\n"
                                       "ElementType = MET_UCHAR\nElementDataFile = LOCAL\nz");
    const Scenario scenario = loaded(made_from({file}), file.parent_path());
    const auto& volume = std::get<GridVolume>(scenario.scene.objects[0].shape);
    EXPECT_EQ(volume.lower, Vec3d(0, 1, 2));
    EXPECT_EQ(volume.upper, Vec3d(2, 3, 4));
}

TEST(NewScenario, TheBoxOfAllFilesStandsOnTheGround) {
    const auto low = test::write_file("low.obj", "v 0 -5 0\nv 1 -5 0\nv 0 -4 0\nf 1 2 3\n");
    const auto high = test::write_file("high.obj", "v 0 5 0\nv 1 5 0\nv 0 6 1\nf 1 2 3\n");
    const Scenario scenario = loaded(made_from({high, low}), low.parent_path());
    ASSERT_EQ(scenario.scene.objects.size(), 3u);
    for (const Vec3f& corner : std::get<Mesh>(scenario.scene.objects[2].shape).positions) {
        EXPECT_LT(corner.y, -5.0f);
        EXPECT_GT(corner.y, -6.0f);
    }
}

std::filesystem::path write_image(const std::string& name) {
    const std::filesystem::path file = test::fresh_path(name);
    const auto output = OIIO::ImageOutput::create(file.string());
    EXPECT_TRUE(output && output->open(file.string(), OIIO::ImageSpec(2, 1, 1, OIIO::TypeDesc::FLOAT)));
    const float pixels[] = {0.25f, 0.75f};
    EXPECT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels));
    output->close();
    return file;
}

TEST(NewScenario, AnImageBelongsToTheMeshBeforeIt) {
    const auto image = write_image("leaf.tif");
    const auto leaves =
        test::write_file("leaves.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    const auto trunk = test::write_file("trunk.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Scenario cut = loaded(made_from({leaves, image, trunk}), image.parent_path());
    ASSERT_EQ(cut.scene.objects.size(), 3u);
    ASSERT_TRUE(std::get<Mesh>(cut.scene.objects[0].shape).alpha);
    EXPECT_FALSE(std::get<Mesh>(cut.scene.objects[1].shape).alpha);

    // The trunk has no texture coordinates, so the image stands beside it.
    const Scenario apart = loaded(made_from({trunk, image}), image.parent_path());
    ASSERT_EQ(apart.scene.objects.size(), 3u);
    EXPECT_TRUE(std::get<Mesh>(apart.scene.objects[1].shape).alpha);
    EXPECT_EQ(std::get<Mesh>(apart.scene.objects[1].shape).positions[0], Vec3f(-1, 0, 0));
}

TEST(NewScenario, ZIsUpWhereItIsSaid) {
    const auto file = test::write_file("scan.obj", "v 0 0 2\nv 1 0 2\nv 0 1 4\nf 1 2 3\n");
    const Scenario scenario = loaded(made_from({file}, UpAxis::z), file.parent_path());
    for (const Vec3f& corner : std::get<Mesh>(scenario.scene.objects[1].shape).positions) EXPECT_LT(corner.z, 2.0f);
    EXPECT_EQ(scenario.receivers.camera->up, Vec3d(0, 0, 1));
    EXPECT_LT(scenario.lights[0].direction.z, 0.0);
}

// Without a slope, the light would fall through meshes in stripes.
TEST(NewScenario, OnlyMeshesGetASlopeBias) {
    EXPECT_EQ(made_from({case_file("bom.obj")})["receivers"]["slope_bias"], 1);
    EXPECT_FALSE(made_from({case_file("noname.vdb")})["receivers"].contains("slope_bias"));
}

TEST(NewScenario, OnlyMeshesAreOpaque) {
    std::vector<DataFile> files;
    files.push_back(read_data_file(case_file("bom.obj"), {}));
    EXPECT_TRUE(is_opaque(files));
    files.push_back(read_data_file(case_file("noname.vdb"), {}));
    EXPECT_FALSE(is_opaque(files));
}

TEST(NewScenario, NamesAreThoseThatTheSchemaTakes) {
    const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (const std::string name : {"my tree (1).obj", "-x.obj", "\xc3\xa4.obj", ".a.obj"}) {
        const auto file = test::write_file(name, mesh);
        EXPECT_NO_THROW(loaded(made_from({file}), file.parent_path())) << name;
    }
    const auto file = test::write_file(std::string(200, 'a') + ".obj", mesh);
    EXPECT_EQ(made_from({file})["name"], std::string(64, 'a'));
    const auto latin = test::write_file("\xe4.obj", mesh);
    EXPECT_THAT(error_of([&] { made_from({latin}); }).message(), HasSubstr("not UTF-8"));
}

TEST(NewScenario, RefusesWhatCannotCastAShadow) {
    const auto lone = test::write_file("lone.obj", "v 0 1 0\nv 1 1 -1\n");
    EXPECT_THAT(error_of([&] { made_from({lone}); }).message(), HasSubstr("a point cloud"));
    const auto empty = test::write_file("empty_2x2x2.raw", std::string(8, '\0'));
    EXPECT_THAT(error_of([&] { made_from({empty}); }).message(), HasSubstr("nothing in it casts a shadow"));
    const auto lines = test::write_file("lines.obj", "v 0 1 0\nv 1 1 -1\nl 1 2\np 1\n");
    EXPECT_THAT(error_of([&] { made_from({lines}); }).message(),
                HasSubstr("a shadow; passed over: lines (1); passed over: points (1)"));
    const base::Error two = error_of([] { made_from({case_file("bom.obj"), case_file("inf.exr")}); });
    EXPECT_EQ(two.code(), base::ErrorCode::usage);
    EXPECT_EQ(two.where(), case_file("inf.exr").string());
}

TEST(NewScenario, RefusesBoxesThatLeaveNoRoom) {
    for (const char* far : {"1e17", "1e-16"}) {
        const std::string text = std::string("v 0 0 0\nv ") + far + " 0 0\nv 0 " + far + " 0\nf 1 2 3\n";
        const auto file = test::write_file("far.obj", text);
        EXPECT_THAT(error_of([&] { made_from({file}); }).message(), HasSubstr("scale it")) << far;
    }
}

TEST(JsonText, KeepsOnOneLineWhatFits) {
    const ordered_json value = ordered_json::parse(R"({"a": [1, 2.5, {"b": null}], "empty": {}, "text": "x\n"})");
    EXPECT_EQ(in_one_line(value), R"({"a": [1, 2.5, {"b": null}], "empty": {}, "text": "x\n"})");
    EXPECT_EQ(in_lines(value), in_one_line(value));
}

TEST(JsonText, BreaksWhatDoesNotFitAndLosesNothing) {
    ordered_json value;
    value["short"] = ordered_json::parse("[1, 2, 3]");
    value["long"] = ordered_json::array();
    for (int i = 0; i < 3; ++i) value["long"].push_back(ordered_json{{"key", std::string(60, 'k')}, {"i", i}});
    const std::string text = in_lines(value), begin = "    {\"key\": \"" + std::string(60, 'k') + "\", \"i\": ";
    EXPECT_EQ(text,
              "{\n  \"short\": [1, 2, 3],\n  \"long\": [\n" + begin + "0},\n" + begin + "1},\n" + begin + "2}\n  ]\n}");
    EXPECT_EQ(ordered_json::parse(text), value);
}

}  // namespace
}  // namespace shadowbench::scene
