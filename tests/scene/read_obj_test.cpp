#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "scene/readers/files.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::error_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using testing::UnorderedElementsAre;

MeshFile read_file(const std::string& text) {
    return read_mesh(test::write_file("a.obj", text));
}

Mesh read(const std::string& text) {
    return read_file(text).mesh;
}

// What was passed over, and how often.
std::map<std::string, std::uint64_t> passed_over(const std::string& text) {
    std::map<std::string, std::uint64_t> counts;
    for (const PassedOver& each : read_file(text).passed_over) counts[each.what] = each.count;
    return counts;
}

const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(ReadObj, SplitsAConvexPolygonIntoTheFanOfItsFirstCorner) {
    EXPECT_THAT(read(corners + "f 1 2 3 4\n").triangles, ElementsAre(Vec3i(0, 1, 2), Vec3i(0, 2, 3)));
}

// Editors leave blanks behind the mark of continuation, which looked like a corner then.
TEST(ReadObj, LinesContinueAfterAMarkWithBlanksBehindIt) {
    for (const char* mark : {"\\\n", "\\ \t\n", "\\ \r\n"})
        EXPECT_EQ(read(corners + "f 1 2 " + mark + "3 4\n").triangles.size(), 2u) << mark;
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

TEST(ReadObj, ReadsLinesThatEndWithACarriageReturn) {
    std::string text = "# made by hand\r" + corners + "f 1 2 \\\n3 # three\nf 1 3 4\n";
    std::replace(text.begin(), text.end(), '\n', '\r');
    EXPECT_THAT(read(text).triangles, ElementsAre(Vec3i(0, 1, 2), Vec3i(0, 2, 3)));
    EXPECT_THAT(error_of([&] { read(text + "f 1 2 99\r"); }).where(), testing::EndsWith(":9"));
    // Where files of both kinds were joined, no line is lost.
    EXPECT_THAT(error_of([] { read(corners + "f 1 2 3\n\ng a\rf 1 2 99\n"); }).where(), testing::EndsWith(":8"));
}

TEST(ReadObj, LinesMayEndWithAComment) {
    const std::string text =
        "v 0 0 0 # first\nv 1 0 0 #second\nv 1 1 0# third \\\nv 0 1 0 #\nvt 0 0 # uv\nf 1/1 2/1 3/1 # 4/1\n"
        "f 1/1 3/1 \\\n4/1 # v 9 9 9\ng a # b\nl 1 2 # line\n";
    const MeshFile file = read_file(text);
    EXPECT_EQ(file.mesh.positions.size(), 4u);
    EXPECT_THAT(file.mesh.triangles, ElementsAre(Vec3i(0, 1, 2), Vec3i(0, 2, 3)));
    EXPECT_EQ(file.mesh.corner_uv.size(), 6u);
    EXPECT_THAT(passed_over(text), UnorderedElementsAre(Pair("lines", 1)));
    EXPECT_THAT(error_of([] { read("v 0 0 # 0\n"); }).message(), HasSubstr("2 numbers"));
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
    EXPECT_EQ(where(corners + "f 1 2 x\n"), "5");
    EXPECT_EQ(where(corners + "f 1 2 3\nf 1 2 5/1\nf 1 2 3\n"), "6");
    EXPECT_EQ(where(corners + "vt 0 0\nf 1 2 3\nf 1/1 2/1 3/2\nf 1 2 3\n"), "7");
    EXPECT_EQ(where(corners + "f -5 1 2\n"), "5");
    EXPECT_EQ(where(corners + "f 0 1 2\n"), "5");
}

TEST(ReadObj, RefusesIndicesThatAreNotThere) {
    for (const char* face : {"f 1 2 5\n", "f 0 1 2\n", "f -5 1 2\n", "f 1/1 2/1 3/1\n", "f 1 2 99999999999999\n"})
        EXPECT_EQ(error_of([&] { read(corners + face); }).code(), base::ErrorCode::bad_input) << face;
}

// tinyobjloader takes memory for the counts of a "t" line.
TEST(ReadObj, TakesNothingFromOtherLines) {
    const std::string face = "f 1 2 3\n";
    for (const char* line : {"t x 2000000000/2000000000/2000000000\n", "t x -1/0/0\n", "l 1 99\np 7\n", "vw 0 nan\n",
                             "# \rt x -1/0/0\r\n", "# f 1 2 99\r\n", "vn nan x\n"}) {
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

// Listed from a corner whose fan covers 4.
TEST(ReadObj, CoversAConcavePolygonOnceFromEveryCorner) {
    const std::string l = "v 2 1 0\nv 2 1 -1\nv 1 1 -1\nv 1 1 -2\nv 0 1 -2\nv 0 1 0\n";
    for (int first = 0; first < 6; ++first) {
        std::string face = "f";
        for (int i = 0; i < 6; ++i) face += " " + std::to_string((first + i) % 6 + 1);
        const Mesh mesh = read(l + face + "\n");
        EXPECT_EQ(mesh.triangles.size(), 4u);
        EXPECT_EQ(test::area(mesh), 3.0) << face;
    }
}

// The library beneath holds the corners of a polygon in a byte.
TEST(ReadObj, TakesPolygonsOfManyCorners) {
    constexpr int corners_of_circle = 1000;
    std::string circle, face = "f";
    for (int i = 0; i < corners_of_circle; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / corners_of_circle;
        circle += fmt::format("v {} {} 0\n", std::cos(angle), std::sin(angle));
        face += fmt::format(" {}", i + 1);
    }
    EXPECT_NEAR(test::area(read(circle + face + "\n")),
                corners_of_circle / 2.0 * std::sin(2.0 * std::numbers::pi / corners_of_circle), 1e-6);
}

TEST(ReadObj, NamesTheLineOfAFaceThatCrossesItself) {
    const base::Error error = error_of([] { read(corners + "f 1 2 3\nf 1 3 2 4\n"); });
    EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
    EXPECT_THAT(error.where(), testing::EndsWith("a.obj:6"));
    EXPECT_THAT(error.message(),
                HasSubstr("crosses itself: its edge from corner 1 to 2 meets the one from corner 3 to 4"));
}

TEST(ReadObj, KeepsTextureCoordinatesOfAConcavePolygonAtTheirCorners) {
    const Mesh mesh = read("v 0 0 0\nv 4 2 0\nv 0 4 0\nv 1 2 0\nvt 0 0\nvt 4 2\nvt 0 4\nvt 1 2\nf 1/1 2/2 3/3 4/4\n");
    ASSERT_EQ(mesh.corner_uv.size(), 6u);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int corner = 0; corner < 3; ++corner) {
            const Vec3f at = mesh.positions[static_cast<std::size_t>(mesh.triangles[t][corner])];
            EXPECT_EQ(mesh.corner_uv[3 * t + static_cast<std::size_t>(corner)], Vec2f(at.x, at.y));
        }
}

// The library would drop a first "v" after a mark and shift all faces.
TEST(ReadObj, TakesAByteOrderMark) {
    const std::string square = "v 0 1 0\nv 1 1 0\nv 1 1 -1\nv 0 1 -1\nv 9 9 9\nf 1 2 3 4\n";
    const Mesh mesh = read("\xef\xbb\xbf" + square);
    EXPECT_EQ(mesh.positions.size(), 5u);
    EXPECT_EQ(test::area(mesh), 1.0);
    // In the middle of a file, where files were joined, it is an error with its line.
    EXPECT_THAT(error_of([&] { read(square + "\xef\xbb\xbf" + square); }).where(), testing::EndsWith(":7"));
    const std::string wide("\xff\xfev\0 \0", 6);
    EXPECT_THAT(error_of([&] { read(wide); }).message(), HasSubstr("UTF-8"));
}

TEST(ReadObj, JoinsLinesThatEndWithABackslash) {
    for (const std::string end : {"\n", "\r\n"}) {
        const Mesh mesh = read("v 0 1 0" + end + "v 1 1 \\" + end + "0" + end + "v 1 1 -1" + end + "v 0 1 -1" + end +
                               "f 1 2 \\" + end + "\\" + end + "3 4" + end);
        EXPECT_EQ(test::area(mesh), 1.0);
        EXPECT_EQ(mesh.positions.size(), 4u);
    }
    EXPECT_EQ(read(corners + "f 1 2 3 \\").triangles.size(), 1u);
    EXPECT_THAT(error_of([] { read(corners + "f 1 2 \\\nx\nf 1 2 3\n"); }).where(), testing::EndsWith(":5"));
    EXPECT_THAT(error_of([] { read(corners + "f 1 \\\n2 3\nf 1 2 x\n"); }).where(), testing::EndsWith(":7"));
}

// A comment may end with a folder's name.
TEST(ReadObj, ACommentDoesNotGoOn) {
    EXPECT_EQ(read("# C:\\models\\\n" + corners + "f 1 2 3 4\n").positions.size(), 4u);
}

// More than the reader takes at a time.
std::string many_faces() {
    std::string text = corners;
    for (int i = 0; i < 150000; ++i) text += "f 1 2 3 4\n";
    return text;
}

TEST(ReadObj, KeepsTheOrderOfFacesThatStandBeforeTheirVertices) {
    const Mesh mesh = read(many_faces() + "f 1 2 5\nf 4 3 2 1\nv 2 2 0\nf -1 1 2\n");
    ASSERT_EQ(mesh.positions.size(), 5u);
    ASSERT_EQ(mesh.triangles.size(), 300004u);
    EXPECT_EQ(mesh.triangles[299999], Vec3i(0, 2, 3));
    EXPECT_EQ(mesh.triangles[300000], Vec3i(0, 1, 4));
    EXPECT_EQ(mesh.triangles[300001], Vec3i(3, 2, 1));
    EXPECT_EQ(mesh.triangles[300003], Vec3i(4, 0, 1));
}

TEST(ReadObj, NamesTheLineOfAFaultFarDown) {
    EXPECT_THAT(error_of([] { read(many_faces() + "f 1 3 2 4\n"); }).where(), testing::EndsWith(":150005"));
    EXPECT_THAT(error_of([] { read(many_faces() + "f 1 2 3 4\nf 1 2 9\nv 2 2 0\n"); }).where(),
                testing::EndsWith(":150006"));
}

TEST(ReadObj, CountsWhatItPassesOver) {
    EXPECT_THAT(passed_over(corners + "f 1 2 3 4\nf 1 2\nf 1/1 2/1\nf 7\nf\nl 1 2 3\nl 1 2\np 1\n"),
                UnorderedElementsAre(Pair("faces of fewer than 3 corners", 4), Pair("lines", 2), Pair("points", 1)));
    EXPECT_THAT(passed_over(corners + "f 1 1 2 2\nf 1 2 3\n"), UnorderedElementsAre(Pair("faces without area", 1)));
    EXPECT_THAT(passed_over(corners + "vertex 0 0 0\ndeform x\nvertex\nf 1 2 3\n"),
                UnorderedElementsAre(Pair("lines of the unknown keyword \"vertex\"", 2),
                                     Pair("lines of the unknown keyword \"deform\"", 1)));
    EXPECT_THAT(passed_over(corners + "cstype bezier\ndeg 3\ncurv 0 1 1 2 3 4\nparm u 0 1\nend\nf 1 2 3\n"),
                UnorderedElementsAre(Pair("free-form curves and surfaces", 1)));
    EXPECT_THAT(passed_over("# c\nmtllib a.mtl\no a\n" + corners + "vn 0 0 1\ng a b\nusemtl x\ns 1\nf 1 2 3\n"),
                IsEmpty());
}

TEST(ReadObj, KeepsFewKindsOfUnknownWords) {
    std::string text = corners + "f 1 2 3\n";
    for (int i = 0; i < 1000; ++i) text += fmt::format("word{} 1\n", i);
    const auto counts = passed_over(text);
    EXPECT_LE(counts.size(), 16u);
    std::uint64_t sum = 0;
    for (const auto& [what, count] : counts) sum += count;
    EXPECT_EQ(sum, 1000u);
}

TEST(ReadObj, RefusesLinesThatBeginWithNoWord) {
    for (const std::string garbage :
         {"1 2 3", "\x01\x02", "<html>", "{", "v\xc3\xa4 1 2 3", "v, 1 2 3", "\\x", "-f 1 2 3"}) {
        const base::Error error = error_of([&] { read(corners + garbage + "\nf 1 2 3\n"); });
        EXPECT_EQ(error.code(), base::ErrorCode::bad_input) << garbage;
        EXPECT_THAT(error.where(), testing::EndsWith(":5")) << garbage;
    }
}

TEST(ReadObj, SaysWhenAFileIsOfAnotherFormat) {
    for (const std::string other : {"solid x\nfacet normal 0 0 1\nouter loop\nendsolid\n", "OFF\n", "Hello, world\n"})
        EXPECT_THAT(error_of([&] { read(other); }).message(), HasSubstr("not a Wavefront OBJ file")) << other;
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
    EXPECT_EQ(error_of([] { read_mesh(test::write_file("a.Fbx", "")); }).message(),
              "the name of a mesh file must end in .obj, .ply, .stl, .gltf, .glb or .pbrt; .Fbx is not read");
    EXPECT_EQ(error_of([] { read_mesh(test::write_file("obj", "")); }).message(),
              "the name of a mesh file must end in .obj, .ply, .stl, .gltf, .glb or .pbrt");
    EXPECT_EQ(error_of([] { read_mesh("/nowhere/a.obj"); }).code(), base::ErrorCode::no_such_file);
    EXPECT_EQ(error_of([] { read_mesh("/nowhere/a.ply"); }).code(), base::ErrorCode::no_such_file);
}

TEST(ReadObj, ReadsTheTree) {
    SHADOWBENCH_NEED_DATA(leaves, "meshes/tree_leaves.obj");
    const Mesh mesh = read_mesh(leaves).mesh;
    EXPECT_EQ(mesh.positions.size(), 1949u);
    EXPECT_EQ(mesh.triangles.size(), 584u * 2);  // all faces are quads
    EXPECT_EQ(mesh.corner_uv.size(), mesh.triangles.size() * 3);
}

}  // namespace
}  // namespace shadowbench::scene
