#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "scene/files.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::error_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Mesh read(const std::string& text) {
    return read_mesh(test::write_file("a.obj", text));
}

const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(ReadObj, SplitsPolygonsIntoFans) {
    EXPECT_THAT(read(corners + "f 1 2 3 4\n").triangles, ElementsAre(Vec3i(0, 1, 2), Vec3i(0, 2, 3)));
}

TEST(ReadObj, CountsNegativeIndicesFromTheEnd) {
    EXPECT_THAT(read(corners + "f -4 -3 -2\n").triangles, ElementsAre(Vec3i(0, 1, 2)));
}

TEST(ReadObj, KeepsTextureCoordinatesOfEveryCorner) {
    const Mesh mesh = read(corners + "vt 0 0\nvt 1 0.5\nvt 0.25 1\nf 1/3/1 2/2/1 3/1/1 4/1/1\nvn 0 0 1\n");
    EXPECT_THAT(mesh.corner_uv,
                ElementsAre(Vec2f(0.25f, 1), Vec2f(1, 0.5f), Vec2f(0, 0), Vec2f(0.25f, 1), Vec2f(0, 0), Vec2f(0, 0)));
}

TEST(ReadObj, DropsTextureCoordinatesThatSomeFacesLack) {
    const Mesh mesh = read(corners + "vt 0 0\nf 1/1 2/1 3/1\nf 1 3 4\n");
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_THAT(mesh.corner_uv, IsEmpty());
}

TEST(ReadObj, ReadsGroupsMaterialsAndWindowsLineEnds) {
    const Mesh mesh = read(
        "mtllib none.mtl\r\no a\r\nv 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nusemtl x\r\ns off\r\nf 1 2 3\r\ng b\r\nf 3 2 "
        "1\r\n");
    EXPECT_THAT(mesh.triangles, ElementsAre(Vec3i(0, 1, 2), Vec3i(2, 1, 0)));
    EXPECT_EQ(mesh.positions[1], Vec3f(1, 0, 0));
}

TEST(ReadObj, TellsTheLineOfWhatIsWrong) {
    const auto where = [](const std::string& text) {
        const base::Error error = error_of([&] { read(text); });
        EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
        return error.where().substr(error.where().rfind(':') + 1);
    };
    EXPECT_EQ(where("# comment\nv 0 nan 0\n"), "2");
    EXPECT_EQ(where("v 0 0 0\n\nv 1e400 0 0\n"), "3");
    EXPECT_EQ(where("v 0 0\n"), "1");
    EXPECT_EQ(where("vt x 0\n"), "1");
    EXPECT_EQ(where(corners + "f 1 2\n"), "5");
    EXPECT_EQ(where(corners + "f 1 2 x\n"), "5");
    EXPECT_EQ(where(corners + "f 1 2 3\nf 1 2 5/1\nf 1 2 3\n"), "6");
    EXPECT_EQ(where(corners + "f -5 1 2\n"), "5");
    EXPECT_EQ(where(corners + "f 0 1 2\n"), "5");
}

TEST(ReadObj, RefusesIndicesThatAreNotThere) {
    for (const char* face : {"f 1 2 5\n", "f 0 1 2\n", "f -5 1 2\n", "f 1/1 2/1 3/1\n", "f 1 2 99999999999999\n"})
        EXPECT_EQ(error_of([&] { read(corners + face); }).code(), base::ErrorCode::bad_input) << face;
}

// tinyobjloader takes memory for the counts of a "t" line, and ends lines at a lone carriage return.
TEST(ReadObj, TakesNothingFromOtherLines) {
    const std::string face = "f 1 2 3\n";
    for (const char* line : {"t x 2000000000/2000000000/2000000000\n", "t x -1/0/0\n", "l 1 99\np 7\n", "vw 0 nan\n",
                             "# \rt x -1/0/0\r\n", "g a\rf 1 2 99\n", "vn nan x\n"}) {
        const Mesh mesh = read(corners + line + face);
        EXPECT_THAT(mesh.triangles, ElementsAre(Vec3i(0, 1, 2))) << line;
    }
}

TEST(ReadObj, TakesNormalsOfAFaceForNothing) {
    EXPECT_THAT(read(corners + "vt 0 0\nf 1//1 2//-7 3//\n").corner_uv, IsEmpty());
    EXPECT_EQ(read(corners + "vt 0 0\nf 1/1/9 2/-1/9 3/1/\n").corner_uv.size(), 3u);
}

TEST(ReadObj, FacesMayStandBeforeTheirVertices) {
    EXPECT_THAT(read("f 1 2 3\n" + corners).triangles, ElementsAre(Vec3i(0, 1, 2)));
}

TEST(ReadObj, AnEmptyFileIsBadInput) {
    const base::Error error = error_of([] { read(""); });
    EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
    EXPECT_THAT(error.message(), HasSubstr("empty"));
}

TEST(ReadObj, NeverCrashesOnAFileCutAnywhere) {
    const std::string text = corners + "vt 0 0\nvt 1 0.5\nf 1/1 2/2 3/1 4/2\n";
    for (std::size_t length = 0; length < text.size(); ++length) try {
            const Mesh mesh = read(text.substr(0, length));
            EXPECT_LE(mesh.triangles.size(), 2u);
        } catch (const base::Error& error) {
            EXPECT_NE(error.code(), base::ErrorCode::internal) << length;
        }
}

TEST(ReadMesh, RefusesOtherFormatsAndMissingFiles) {
    EXPECT_THAT(error_of([] { read_mesh(test::write_file("a.stl", "")); }).message(), HasSubstr(".obj or .ply"));
    EXPECT_EQ(error_of([] { read_mesh("/nowhere/a.obj"); }).code(), base::ErrorCode::no_such_file);
    EXPECT_EQ(error_of([] { read_mesh("/nowhere/a.ply"); }).code(), base::ErrorCode::no_such_file);
}

TEST(ReadObj, ReadsTheTree) {
    SHADOWBENCH_NEED_DATA(leaves, "meshes/tree_leaves.obj");
    const Mesh mesh = read_mesh(leaves);
    EXPECT_EQ(mesh.positions.size(), 1949u);
    EXPECT_EQ(mesh.triangles.size(), 584u * 2);  // all faces are quads
    EXPECT_EQ(mesh.corner_uv.size(), mesh.triangles.size() * 3);
}

}  // namespace
}  // namespace shadowbench::scene
