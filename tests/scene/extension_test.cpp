// Files of every kind are known by their extension, whatever its case; an unknown one is named.
#include "scene/readers/extension.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/readers/files.h"
#include "scene/scenario.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::bytes_of;
using test::error_of;
using testing::HasSubstr;

// `keys` may be empty, or begin with a comma.
Object load(const std::string& type, const fs::path& file, const std::string& keys = "") {
    json document = json::parse(R"({"name": "files", "techniques": [{"type": "deep"}],
                                    "lights": [{"type": "directional", "direction": [0, -1, 0]}]})");
    document["scene"]["objects"] = {
        json::parse(fmt::format(R"({{"type": "{}", "file": "{}"{}}})", type, file.filename().string(), keys))};
    return load_scenario(document, {file.parent_path()}).scene.objects[0];
}

TEST(ExtensionOf, IsInLowerCase) {
    EXPECT_EQ(extension_of("folder.d/A.Stl"), ".stl");
    EXPECT_EQ(extension_of("folder.d/a.tar.VDB"), ".vdb");
    EXPECT_EQ(extension_of("folder.d/a"), "");
    EXPECT_EQ(extension_of("a.\xc3\x84"), ".\xc3\x84");
}

TEST(UnknownExtension, NamesItAndTheKnownOnes) {
    EXPECT_EQ(unknown_extension("a.x", "mesh", {".obj"}), "the name of a mesh file must end in .obj; .x is not read");
    EXPECT_EQ(unknown_extension("a", "mesh", {".obj", ".ply"}), "the name of a mesh file must end in .obj or .ply");
}

TEST(Extensions, OfMeshesMayHaveAnyCase) {
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                      ply =
                          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
                          "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                          "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
                      stl =
                          "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                          "endfacet\nendsolid\n";
    for (const auto& [name, text] : {std::pair{"a.obj", obj}, {"A.OBJ", obj}, {"a.Ply", ply}, {"A.STL", stl}})
        EXPECT_EQ(std::get<Mesh>(load("mesh", test::write_file(name, text)).shape).triangles.size(), 1u) << name;
}

TEST(Extensions, OfHairMayHaveAnyCase) {
    const std::string points = bytes_of(0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f);
    std::string tfx = bytes_of(3.0f, 1u, 2u), hair = "HAIR" + bytes_of(1u, 2u, 2u, 1u);
    tfx.resize(296, '\0');
    hair.resize(128, '\0');
    for (const auto& [name, bytes] : {std::pair{"A.TFX", tfx}, {"a.Tfx", tfx}, {"A.HAIR", hair}, {"a.hair", hair}})
        EXPECT_EQ(std::get<Hair>(load("hair", test::write_file(name, bytes + points), R"(, "radius": 1)").shape)
                      .points.size(),
                  2u)
            << name;
}

TEST(Extensions, OfVolumesAndTexturesMayHaveAnyCase) {
    const fs::path vdb = test::fresh_path("A.VDB");
    fs::copy_file(fs::path(SHADOWBENCH_SOURCE_DIR) / "tests/cases/noname.vdb", vdb);
    EXPECT_FALSE(std::get<GridVolume>(load("volume", vdb).shape).density.empty());
    // A grey image of one texel, of 51 in 255.
    std::string grey(19, '\0');
    grey[2] = 3;
    grey[12] = grey[14] = 1;
    grey[16] = 8;
    grey[18] = 0x33;
    EXPECT_THAT(read_alpha(test::write_file("GREY.TGA", grey)).alpha,
                testing::ElementsAre(testing::FloatNear(0.2f, 1e-6f)));
}

// It used to be read as raw values whatever it was, so the message asked for their format.
TEST(Extensions, OfVolumesThatAreUnknownAreNamed) {
    const fs::path file = test::write_file("a.abc", "11111\n");
    for (const char* keys : {"", R"(, "grid": 0)", R"(, "channel": "red")", R"(, "lower": [0, 0, 0])"}) {
        const base::Error error = error_of([&] { load("volume", file, keys); });
        EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
        EXPECT_EQ(error.where(), "/scene/objects/0/file");
        EXPECT_THAT(error.message(), HasSubstr("must end in .vdb, .nvdb, .pvm, .dds, .nrrd, .nhdr, .mhd, .mha, .vol, "
                                               ".slc, .pbrt, .raw or .gz; .abc is not read"));
        EXPECT_THAT(error.message(), HasSubstr(R"("format", "size", and "spacing" or "lower" and "upper")"));
    }
}

TEST(Extensions, OfRawValuesMayBeAny) {
    const std::string box = R"(, "lower": [0, 0, 0], "upper": [1, 1, 1])";
    for (const char* name : {"a.raw", "A.RAW", "a.u8", "a"}) {
        const fs::path file = test::write_file(name, "\x7f");
        EXPECT_NO_THROW(load("volume", file, box + R"(, "format": "uint8", "size": [1, 1, 1])")) << name;
        EXPECT_THAT(error_of([&] { load("volume", file, box + R"(, "size": [1, 1, 1])"); }).message(),
                    HasSubstr("\"format\" is missing"))
            << name;
    }
    for (const char* name : {"a.raw", "a"})
        EXPECT_THAT(error_of([&] { load("volume", test::write_file(name, "\x7f")); }).message(),
                    HasSubstr("\"format\" is missing"))
            << name;
}

}  // namespace
}  // namespace shadowbench::scene
