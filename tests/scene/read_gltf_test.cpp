#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
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
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

const std::vector<Vec3f> square{Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(1, 1, 0), Vec3f(0, 1, 0)};
const std::vector<std::uint16_t> halves{0, 1, 2, 0, 2, 3};

MeshFile read(const GltfMaker& maker) {
    return read_mesh(test::write_file("a.glb", maker.glb()));
}

std::vector<std::pair<std::string, std::uint64_t>> passed_over(const MeshFile& file) {
    std::vector<std::pair<std::string, std::uint64_t>> list;
    for (const PassedOver& each : file.passed_over) list.emplace_back(each.what, each.count);
    return list;
}

// A unit square, as the mesh of a node.
GltfMaker square_maker() {
    GltfMaker maker;
    const int points = maker.points(square), indices = maker.indices(halves);
    maker.mesh({{"attributes", {{"POSITION", points}}}, {"indices", indices}});
    return maker;
}

void expect_near(const Vec3f& at, const Vec3f& expected) {
    EXPECT_LT((at - expected).length(), 1e-6f) << at << " is not " << expected;
}

// The message, whose place must end as given.
std::string refused(const GltfMaker& maker, const std::string& place) {
    const base::Error error = error_of([&] { read(maker); });
    EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
    EXPECT_THAT(error.where(), EndsWith(place)) << error.what();
    return error.message();
}

// Without the hierarchy, the first square would lie at the origin.
TEST(ReadGltf, PlacesMeshesByTheirNodes) {
    const MeshFile file = read_mesh(fs::path(SHADOWBENCH_SOURCE_DIR) / "tests/cases/placed.gltf");
    const std::vector<Vec3f>& at = file.mesh.positions;
    ASSERT_EQ(at.size(), 12u);
    const std::vector<Vec3f> expected{Vec3f(10, 0, 0), Vec3f(12, 0, 0), Vec3f(12, 3, 0), Vec3f(10, 3, 0),
                                      Vec3f(0, 0, 5),  Vec3f(0, 0, 4),  Vec3f(0, 1, 4),  Vec3f(0, 1, 5),
                                      Vec3f(-1, 0, 0), Vec3f(-2, 0, 0), Vec3f(-2, 1, 0), Vec3f(-1, 1, 0)};
    for (std::size_t i = 0; i < expected.size(); ++i) expect_near(at[i], expected[i]);
    ASSERT_EQ(file.mesh.triangles.size(), 6u);
    EXPECT_EQ(file.mesh.triangles[5], Vec3i(8, 10, 11));
    EXPECT_NEAR(test::area(file.mesh), 8.0, 1e-6);
    EXPECT_THAT(passed_over(file), IsEmpty());
    ASSERT_TRUE(file.mesh.alpha);
    for (const Vec2f& uv : file.mesh.corner_uv) EXPECT_EQ(sample(*file.mesh.alpha, uv.x, uv.y), 0.5f);
}

TEST(ReadGltf, AppliesScaleThenRotationThenTranslation) {
    GltfMaker maker = square_maker();
    // A third of a turn around (1, 1, 1): x to y, y to z, z to x. Written twice as long as a unit quaternion.
    maker.document["nodes"][0].update(
        json{{"translation", {1, 2, 3}}, {"rotation", {1, 1, 1, 1}}, {"scale", {2, 5, 7}}});
    const Mesh mesh = read(maker).mesh;
    expect_near(mesh.positions[1], Vec3f(1, 4, 3));
    expect_near(mesh.positions[3], Vec3f(1, 2, 8));
}

TEST(ReadGltf, ReadsTextAndBinaryAlike) {
    const GltfMaker maker = square_maker();
    test::write_file("my data.bin", maker.bytes + "more");
    const Mesh binary = read(maker).mesh;
    const Mesh text = read_mesh(test::write_file("a.gltf", maker.text("my%20data.bin"))).mesh;
    EXPECT_EQ(binary.positions, square);
    EXPECT_EQ(text.positions, square);
    EXPECT_EQ(text.triangles, binary.triangles);
    // A document filled up with a byte of 0: the length of the file stays.
    GltfMaker spare = maker;
    for (std::string name = "x"; spare.text("").size() % 4 != 3; name += "x")
        spare.document["asset"]["generator"] = name;
    std::string filled = spare.glb();
    filled[12 + 8 + spare.text("").size()] = '\0';
    EXPECT_EQ(read_mesh(test::write_file("zero.glb", filled)).mesh.positions, square);
    // The content tells them apart, not the name.
    EXPECT_EQ(read_mesh(test::write_file("b.gltf", maker.glb())).mesh.positions, square);
    EXPECT_EQ(read_mesh(test::write_file("B.GLTF", "\xef\xbb\xbf" + maker.text("my%20data.bin"))).mesh.positions,
              square);
}

TEST(ReadGltf, ReadsStripsFansAndIndicesOfEveryType) {
    const auto area_of = [](int mode, auto indices, std::size_t triangles) {
        GltfMaker maker;
        const int points = maker.points(square), list = maker.indices(indices);
        maker.mesh({{"attributes", {{"POSITION", points}}}, {"indices", list}, {"mode", mode}});
        const Mesh mesh = read(maker).mesh;
        EXPECT_EQ(mesh.triangles.size(), triangles);
        return test::area(mesh);
    };
    EXPECT_EQ(area_of(4, std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, 2), 1.0);
    EXPECT_EQ(area_of(4, std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}, 2), 1.0);
    EXPECT_EQ(area_of(5, std::vector<std::uint16_t>{0, 1, 3, 2}, 2), 1.0);
    EXPECT_EQ(area_of(5, std::vector<std::uint16_t>{0, 1, 3, 3, 1, 2}, 2), 1.0) << "a strip may repeat vertices";
    EXPECT_EQ(area_of(6, std::vector<std::uint16_t>{0, 1, 2, 3}, 2), 1.0);
    GltfMaker maker;
    const int points = maker.points({square[0], square[1], square[3]});
    maker.mesh({{"attributes", {{"POSITION", points}}}});
    EXPECT_EQ(test::area(read(maker).mesh), 0.5) << "without indices";
}

TEST(ReadGltf, KeepsTheOrientationOfStrips) {
    GltfMaker maker;
    const int points = maker.points(square), list = maker.indices(std::vector<std::uint16_t>{0, 1, 3, 2});
    maker.mesh({{"attributes", {{"POSITION", points}}}, {"indices", list}, {"mode", 5}});
    EXPECT_THAT(read(maker).mesh.triangles, ElementsAre(Vec3i(0, 1, 3), Vec3i(3, 1, 2)));
}

TEST(ReadGltf, CountsWhatItPassesOver) {
    GltfMaker maker = square_maker();
    const json attributes{{"POSITION", 0}};
    maker.mesh({{"attributes", attributes}, {"mode", 0}});
    maker.mesh({{"attributes", attributes}, {"mode", 1}});
    maker.mesh({{"attributes", attributes}, {"mode", 3}});
    maker.mesh({{"attributes", json::object()}});
    const int flat = maker.indices(std::vector<std::uint8_t>{0, 1, 1, 0, 1, 2, 3});
    maker.mesh({{"attributes", attributes}, {"indices", flat}, {"targets", {attributes, attributes}}});
    maker.document["nodes"][0]["skin"] = 0;
    maker.document["animations"] = json::array({json::object(), json::object()});
    EXPECT_THAT(
        passed_over(read(maker)),
        ElementsAre(Pair("skins", 1), Pair("primitives of points", 1), Pair("primitives of lines", 2),
                    Pair("primitives without positions", 1), Pair("morph targets", 2),
                    Pair("corners after the last triangle", 1), Pair("faces without area", 1), Pair("animations", 2)));
}

TEST(ReadGltf, SharesPositionsBetweenPrimitives) {
    GltfMaker maker;
    const int points = maker.points(square);
    json primitives = json::array();
    for (const std::uint8_t last : {std::uint8_t{2}, std::uint8_t{3}})
        primitives.push_back({{"attributes", {{"POSITION", points}}},
                              {"indices", maker.indices(std::vector<std::uint8_t>{0, 1, last})}});
    maker.push("meshes", json{{"primitives", primitives}});
    maker.push("nodes", json{{"mesh", 0}});
    const Mesh mesh = read(maker).mesh;
    EXPECT_EQ(mesh.positions, square);
    EXPECT_THAT(mesh.triangles, ElementsAre(Vec3i(0, 1, 2), Vec3i(0, 1, 3)));
}

// Positions and something else by turns, then whole numbers for fractions.
TEST(ReadGltf, ReadsInterleavedAndNormalizedPositions) {
    std::string mixed;
    for (const Vec3f& at : square) mixed += bytes_of(9.0f, at.x, at.y, at.z, 9.0f);
    GltfMaker strided;
    const int view = strided.view(mixed, {{"byteStride", 20}});
    strided.accessor(view, 5126, 4, "VEC3", {{"byteOffset", 4}});
    strided.mesh({{"attributes", {{"POSITION", 0}}}, {"mode", 6}});
    EXPECT_EQ(read(strided).mesh.positions, square);

    const std::vector<std::int16_t> corners{0, 0, 0, 32767, 0, -32768, 0, 32767, 0};
    std::string packed;
    for (const std::int16_t value : corners) packed += bytes_of(value);
    GltfMaker fractions;
    fractions.accessor(fractions.view(packed), 5122, 3, "VEC3", {{"normalized", true}});
    fractions.mesh({{"attributes", {{"POSITION", 0}}}});
    EXPECT_THAT(read(fractions).mesh.positions, ElementsAre(Vec3f(0, 0, 0), Vec3f(1, 0, -1), Vec3f(0, 1, 0)));
    fractions.document["accessors"][0]["normalized"] = false;
    EXPECT_EQ(read(fractions).mesh.positions[1], Vec3f(32767, 0, -32768));
}

TEST(ReadGltf, ReplacesTheElementsOfASparseAccessor) {
    GltfMaker maker = square_maker();
    const int places = maker.view(bytes_of(std::uint8_t{3}, std::uint8_t{1})),
              values = maker.view(bytes_of(7.0f, 8.0f, 9.0f, 4.0f, 5.0f, 6.0f));
    const json sparse{{"count", 2},
                      {"indices", {{"bufferView", places}, {"componentType", 5121}}},
                      {"values", {{"bufferView", values}}}};
    maker.document["accessors"][0]["sparse"] = sparse;
    EXPECT_THAT(read(maker).mesh.positions,
                ElementsAre(Vec3f(0, 0, 0), Vec3f(4, 5, 6), Vec3f(1, 1, 0), Vec3f(7, 8, 9)));
    // Without a view of its own, the rest is 0.
    maker.document["accessors"][0].erase("bufferView");
    EXPECT_THAT(read(maker).mesh.positions,
                ElementsAre(Vec3f(0, 0, 0), Vec3f(4, 5, 6), Vec3f(0, 0, 0), Vec3f(7, 8, 9)));
    maker.document["accessors"][0]["count"] = 3;
    EXPECT_THAT(refused(maker, "/accessors/0/sparse/indices"), HasSubstr("element 3 of 3"));
}

TEST(ReadGltf, ShowsTheSceneThatTheFileNames) {
    GltfMaker maker = square_maker();
    maker.push("nodes", json{{"mesh", 0}, {"translation", {0, 0, 9}}});
    EXPECT_EQ(test::area(read(maker).mesh), 2.0) << "without scenes, every node that is no child";
    maker.document["scenes"] = json::array({{{"nodes", json::array({0})}}, {{"nodes", json::array({1})}}});
    EXPECT_EQ(read(maker).mesh.positions[0], Vec3f(0, 0, 0)) << "the first";
    maker.document["scene"] = 1;
    const MeshFile file = read(maker);
    EXPECT_EQ(file.mesh.positions[0], Vec3f(0, 0, 9));
    EXPECT_EQ(file.mesh.positions.size(), 4u);
    EXPECT_THAT(passed_over(file), ElementsAre(Pair("other scenes", 1)));
}

TEST(ReadGltf, KeepsTextureCoordinatesAsMeshesHaveThem) {
    GltfMaker maker = square_maker();
    const int uvs = maker.uvs({Vec2f(0, 1), Vec2f(1, 1), Vec2f(1, 0.25f), Vec2f(0, 0)});
    maker.document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = uvs;
    const Mesh mesh = read(maker).mesh;
    EXPECT_FALSE(mesh.alpha);
    EXPECT_THAT(mesh.corner_uv,
                ElementsAre(Vec2f(0, 0), Vec2f(1, 0), Vec2f(1, 0.75f), Vec2f(0, 0), Vec2f(1, 0.75f), Vec2f(0, 1)));
}

}  // namespace
}  // namespace shadowbench::scene
