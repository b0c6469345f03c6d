// glTF files that are damaged, hostile, or need what is not read: each gets one error with its place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/gltf_maker.h"
#include "scene/readers/files.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::bytes_of;
using test::error_of;
using test::GltfMaker;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

const std::vector<Vec3f> corners{Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0)};

GltfMaker triangle() {
    GltfMaker maker;
    const int points = maker.points(corners), indices = maker.indices(std::vector<std::uint16_t>{0, 1, 2});
    maker.mesh({{"attributes", {{"POSITION", points}}}, {"indices", indices}});
    return maker;
}

// The message; the place must end as given.
std::string refused(const std::string& name, const std::string& bytes, const std::string& place,
                    base::ErrorCode code = base::ErrorCode::bad_input) {
    const base::Error error = error_of([&] { read_mesh(test::write_file(name, bytes)); });
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_THAT(error.where(), EndsWith(place)) << error.what();
    return error.message();
}

std::string refused(const GltfMaker& maker, const std::string& place) {
    return refused("a.glb", maker.glb(), place);
}

// With the value at a JSON pointer replaced.
std::string refused_with(const std::string& pointer, const json& value, const std::string& place) {
    GltfMaker maker = triangle();
    maker.document[json::json_pointer(pointer)] = value;
    return refused(maker, place);
}

TEST(ReadGltfRefused, AFileCutAnywhere) {
    const auto read_cut = [](const fs::path& file) { read_mesh(file); };
    const std::string binary = triangle().glb();
    test::expect_cuts_refused(binary, "cut.glb", binary.size(), read_cut);
    const GltfMaker maker = triangle();
    test::write_file("a.bin", maker.bytes);
    const std::string text = maker.text("a.bin");
    test::expect_cuts_refused(text, "cut.gltf", text.size(), read_cut);
}

TEST(ReadGltfRefused, OtherFormats) {
    for (const char* other : {"", "v 0 0 0\n", "glT", "  \n", "[1]"})
        EXPECT_THAT(refused("a.gltf", other, "byte 0"), HasSubstr("not a glTF file")) << other;
    EXPECT_THAT(refused("a.gltf", "{}", ": /"), HasSubstr("\"asset\" is missing"));
    EXPECT_THAT(refused("a.gltf", R"({"asset": {"version": "1.0"}})", "/asset/version"), HasSubstr("glTF 2.0"));
    EXPECT_THAT(refused("a.glb", "glTF" + bytes_of(std::uint32_t{1}, std::uint32_t{12}), "byte 4"),
                HasSubstr("version 1"));
    EXPECT_EQ(error_of([] { read_mesh("/nowhere/a.glb"); }).code(), base::ErrorCode::no_such_file);
}

TEST(ReadGltfRefused, JsonThatIsDamagedWithItsLine) {
    const base::Error error = error_of([] { read_mesh(test::write_file("a.gltf", "{\n\"asset\": }")); });
    EXPECT_THAT(error.where(), HasSubstr("a.gltf:2:"));
    EXPECT_THAT(error.message(), HasSubstr("near"));
    const std::string deep = "{\"extras\": " + std::string(100'000, '[') + std::string(100'000, ']') + "}";
    EXPECT_THAT(refused("a.gltf", deep, ""), HasSubstr("nested deeper"));
}

TEST(ReadGltfRefused, ValuesOfAWrongTypeOrRange) {
    EXPECT_THAT(refused_with("/accessors/0/count", "3", "/accessors/0/count"), HasSubstr("whole number"));
    EXPECT_THAT(refused_with("/accessors/0/count", -3, "/accessors/0/count"), HasSubstr("whole number"));
    EXPECT_THAT(refused_with("/accessors/0/count", 2.5, "/accessors/0/count"), HasSubstr("whole number"));
    EXPECT_THAT(refused_with("/accessors/0/count", 1e30, "/accessors/0/count"), HasSubstr("whole number"));
    EXPECT_THAT(refused_with("/accessors/0/componentType", 5124, "/accessors/0/componentType"), HasSubstr("5124"));
    EXPECT_THAT(refused_with("/accessors/0/type", "VEC5", "/accessors/0/type"), HasSubstr("VEC3"));
    EXPECT_THAT(refused_with("/accessors/0/bufferView", 9, "/accessors/0/bufferView"), HasSubstr("number 9"));
    EXPECT_THAT(refused_with("/bufferViews/0/buffer", 1, "/bufferViews/0/buffer"), HasSubstr("which has 1"));
    EXPECT_THAT(refused_with("/nodes/0/mesh", 1, "/nodes/0/mesh"), HasSubstr("counted from 0"));
    EXPECT_THAT(refused_with("/nodes/0/scale", json::array({1, 2}), "/nodes/0/scale"), HasSubstr("needs 3"));
    EXPECT_THAT(refused_with("/nodes/0/rotation", json::array({0, 0, 0, 0}), "/nodes/0/rotation"),
                HasSubstr("quaternion"));
    EXPECT_THAT(refused_with("/nodes/0/translation", json::array({0, 1e19, 0}), "/nodes/0/translation"),
                HasSubstr("finite"));
    EXPECT_THAT(refused_with("/meshes/0/primitives/0/mode", 7, "/meshes/0/primitives/0/mode"), HasSubstr("mode"));
    EXPECT_THAT(refused_with("/meshes/0/primitives", json::array({7}), "/meshes/0/primitives/0"), HasSubstr("object"));
    EXPECT_THAT(refused_with("/materials", json::array({{{"alphaMode", "CLEAR"}}}), "/materials/0/alphaMode"),
                HasSubstr("MASK"));
}

TEST(ReadGltfRefused, ArraysThatReachBeyondTheirBytes) {
    EXPECT_THAT(refused_with("/accessors/0/count", 4, "/accessors/0"), HasSubstr("4 elements of 12 bytes"));
    EXPECT_THAT(refused_with("/accessors/0/count", 150'000'000, "/accessors/0"), HasSubstr("room for 3"));
    EXPECT_THAT(refused_with("/accessors/0/byteOffset", 4, "/accessors/0"), HasSubstr("room for 2"));
    EXPECT_THAT(refused_with("/bufferViews/0/byteLength", 1000, "/bufferViews/0"), HasSubstr("1000 bytes"));
    EXPECT_THAT(refused_with("/bufferViews/0/byteOffset", 1u << 30, "/bufferViews/0"), HasSubstr("the buffer has"));
    EXPECT_THAT(refused_with("/accessors/0/type", "VEC2", "/accessors/0"), HasSubstr("positions have 3"));
    EXPECT_THAT(refused_with("/accessors/1/componentType", 5126, "/accessors/1"), HasSubstr("room for"));
    GltfMaker zeros = triangle();
    zeros.document["accessors"][0].erase("bufferView");
    zeros.document["accessors"][0]["count"] = 150'000'000;
    EXPECT_THAT(refused(zeros, "/accessors/0"), HasSubstr("without a view"));
}

TEST(ReadGltfRefused, IndicesAndPositionsOutOfRange) {
    GltfMaker maker;
    const int points = maker.points(corners), indices = maker.indices(std::vector<std::uint8_t>{0, 1, 3});
    maker.mesh({{"attributes", {{"POSITION", points}}}, {"indices", indices}});
    EXPECT_THAT(refused(maker, "/meshes/0/primitives/0"), HasSubstr("corner 2 names vertex 3, but there are 3"));
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -2e18f}) {
        GltfMaker wrong;
        const int list = wrong.points({corners[0], Vec3f(0, bad, 0), corners[1]});
        wrong.mesh({{"attributes", {{"POSITION", list}}}});
        EXPECT_THAT(refused(wrong, "/accessors/0"), HasSubstr("element 1: "));
    }
    EXPECT_THAT(refused_with("/nodes/0/matrix", json::array({1e18, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1e18, 0, 0, 1}),
                             "/nodes/0"),
                HasSubstr("moves a vertex beyond"));
    EXPECT_THAT(refused_with("/nodes/0/matrix", json::array({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2}),
                             "/nodes/0/matrix"),
                HasSubstr("last row"));
}

TEST(ReadGltfRefused, NodesThatAreNoTree) {
    GltfMaker circle = triangle();
    circle.document["nodes"][0]["children"] = json::array({0});
    circle.document["scenes"] = json::array({{{"nodes", json::array({0})}}});
    EXPECT_THAT(refused(circle, "/nodes/0"), HasSubstr("reached twice"));
    GltfMaker shared = triangle();
    shared.push("nodes", json{{"children", json::array({0})}});
    shared.push("nodes", json{{"children", json::array({0})}});
    EXPECT_THAT(refused(shared, "/nodes/0"), HasSubstr("must be a tree"));
}

// A chain of nodes must not overflow the stack.
TEST(ReadGltfRefused, ADeepTreeIsRead) {
    GltfMaker maker = triangle();
    for (int i = 0; i < 100'000; ++i)
        maker.push("nodes", json{{"children", json::array({i})}, {"translation", json::array({1, 0, 0})}});
    EXPECT_EQ(read_mesh(test::write_file("a.glb", maker.glb())).mesh.positions[0], Vec3f(100'000, 0, 0));
}

// 20,000 nodes show a mesh of 20,000 vertices.
TEST(ReadGltfRefused, MeshesRepeatedTooOftenBeforeMemoryIsTaken) {
    GltfMaker maker;
    const int points = maker.points(std::vector<Vec3f>(20'000, Vec3f(1, 2, 3)));
    maker.mesh({{"attributes", {{"POSITION", points}}}});
    for (int i = 1; i < 20'000; ++i) maker.push("nodes", json{{"mesh", 0}});
    EXPECT_THAT(refused(maker, "/meshes"), HasSubstr("over 200000000 vertices or triangles"));
}

TEST(ReadGltfRefused, ExtensionsThatItNeeds) {
    EXPECT_THAT(refused_with("/extensionsRequired", json::array({"EXT_meshopt_compression"}), "/extensionsRequired/0"),
                HasSubstr("EXT_meshopt_compression, which is not read: write it without"));
    GltfMaker draco = triangle();
    draco.document["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = json::object();
    EXPECT_EQ(read_mesh(test::write_file("b.glb", draco.glb())).mesh.positions, corners) << "the bytes are there";
    draco.document["accessors"][0].erase("bufferView");
    EXPECT_THAT(refused(draco, "/meshes/0"), HasSubstr("compressed by KHR_draco_mesh_compression"));
    GltfMaker harmless = triangle();
    harmless.document["extensionsRequired"] = json::array({"KHR_materials_unlit", "KHR_mesh_quantization"});
    EXPECT_EQ(read_mesh(test::write_file("c.glb", harmless.glb())).mesh.positions, corners);
}

// A file from a stranger must not open others.
TEST(ReadGltfRefused, BuffersOutsideOfItsFolder) {
    const GltfMaker maker = triangle();
    const fs::path outside = test::write_file("outside.bin", maker.bytes);
    const fs::path folder = outside.parent_path() / "inside";
    fs::create_directories(folder);
    fs::remove(folder / "link.bin");
    fs::create_symlink(outside, folder / "link.bin");
    for (const std::string& uri : {std::string("../outside.bin"), outside.string(), std::string("%2e%2e/outside.bin"),
                                   std::string("link.bin"), std::string("https://example.org/a.bin")}) {
        const std::string message = refused("inside/a.gltf", maker.text(uri), "/buffers/0/uri");
        EXPECT_THAT(message, Not(HasSubstr(folder.string()))) << uri;
    }
    const std::string gone =
        refused("inside/a.gltf", maker.text("gone.bin"), "/buffers/0/uri", base::ErrorCode::no_such_file);
    EXPECT_THAT(gone, HasSubstr("in its own folder"));
}

TEST(ReadGltfRefused, DataThatIsNotInBase64) {
    GltfMaker maker = triangle();
    for (const char* uri :
         {"data:application/octet-stream;base64,AA*A", "data:;base64,A", "data:text/plain,AAAA", "data:;base64"})
        EXPECT_THAT(refused("a.gltf", maker.text(uri), "/buffers/0/uri"), HasSubstr("base64")) << uri;
    EXPECT_THAT(refused("a.gltf", maker.text("data:;base64,AAAA"), "/buffers/0/byteLength"),
                HasSubstr("but there are 3"));
}

}  // namespace
}  // namespace shadowbench::scene
