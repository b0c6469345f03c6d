#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "scene/packed_volume.h"
#include "scene/readers/files.h"
#include "scene/readers/read_mesh.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::bytes_of;
using test::error_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

std::string header(const std::string& format, const std::string& vertices = "4", const std::string& faces = "1") {
    return "ply\nformat " + format + " 1.0\ncomment made by hand\nelement vertex " + vertices +
           "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nelement face " + faces +
           "\nproperty list uchar int vertex_indices\nend_header\n";
}

const std::string ascii = header("ascii") + "0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n4 0 1 2 3\n";

template <typename T>
std::string ordered(T value, bool big) {
    std::string bytes = bytes_of(value);
    if (big) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

std::string binary(bool big) {
    std::string bytes = header(big ? "binary_big_endian" : "binary_little_endian");
    for (const auto& [x, y] : {std::pair{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}})
        bytes += ordered(x, big) + ordered(y, big) + ordered(0.0f, big) + "\x09";
    bytes += "\x04";
    for (const int index : {0, 1, 2, 3}) bytes += ordered(index, big);
    return bytes;
}

Mesh read(const std::string& bytes) {
    return read_mesh(test::write_file("a.ply", bytes)).mesh;
}

std::vector<std::pair<std::string, std::uint64_t>> passed_over(const std::string& bytes) {
    std::vector<std::pair<std::string, std::uint64_t>> list;
    for (const PassedOver& each : read_mesh(test::write_file("a.ply", bytes)).passed_over)
        list.emplace_back(each.what, each.count);
    return list;
}

// Two strips: four vertices, then five of which the first three repeat one.
std::string strips(const std::string& format, const std::string& type) {
    return "ply\nformat " + format +
           " 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
           "element tristrips 1\nproperty list int " +
           type + " vertex_indices\nend_header\n";
}
const std::vector<int> strip_list{0, 1, 3, 2, -1, 2, 2, 1, 4, 3, -1, 0, 1, -1};

TEST(ReadPly, ReadsAllThreeEncodingsAlike) {
    for (const std::string& bytes : {ascii, binary(false), binary(true)}) {
        const Mesh mesh = read(bytes);
        EXPECT_THAT(mesh.positions, ElementsAre(Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(1, 1, 0), Vec3f(0, 1, 0)));
        EXPECT_THAT(mesh.triangles, ElementsAre(Vec3i(0, 1, 2), Vec3i(0, 2, 3)));
    }
}

TEST(ReadPly, RefusesAFileCutAnywhere) {
    const auto read_file = [](const std::filesystem::path& file) { read_mesh(file); };
    // Without its last number; the end of the last line may be missing.
    test::expect_cuts_refused(ascii, "cut.ply", ascii.size() - 2, read_file);
    test::expect_cuts_refused(binary(false), "cut.ply", binary(false).size(), read_file);
    test::expect_cuts_refused(binary(true), "cut.ply", binary(true).size(), read_file);
}

TEST(ReadPly, TakesTextureCoordinatesOfVerticesToTheCorners) {
    const Mesh mesh = read(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\nproperty "
        "float s\nproperty float t\nelement face 1\nproperty list uchar uint vertex_index\nend_header\n"
        "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 2 1 0\n");
    EXPECT_THAT(mesh.corner_uv, ElementsAre(Vec2f(0, 1), Vec2f(1, 0), Vec2f(0, 0)));
}

TEST(ReadPly, ReadsPastOtherElementsAndProperties) {
    const Mesh mesh = read(
        "ply\nformat ascii 1.0\nelement camera 2\nproperty list uchar float values\nelement vertex 3\nproperty list "
        "uchar int tags\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty int id\n"
        "property list uchar int vertex_indices\nproperty float area\nend_header\n"
        "2 5 6\n0\n1 7 0 0 0\n0 1 0 0\n0 0 1 0\n42 3 0 1 2 0.5\n");
    EXPECT_THAT(mesh.triangles, ElementsAre(Vec3i(0, 1, 2)));
    EXPECT_EQ(mesh.positions[1], Vec3f(1, 0, 0));
}

TEST(ReadPly, RefusesCountsTheFileCannotHoldBeforeMemoryIsTaken) {
    for (const char* format : {"ascii", "binary_little_endian"}) {
        EXPECT_THAT(error_of([&] { read(header(format, "200000000")); }).message(), HasSubstr("too short"));
        EXPECT_THAT(error_of([&] { read(header(format, "99999999999999")); }).message(), HasSubstr("limit"));
        EXPECT_EQ(error_of([&] { read(header(format, "-1")); }).code(), base::ErrorCode::bad_input);
    }
    std::string long_list = ascii;
    long_list.replace(long_list.rfind("4 0 1 2 3"), 1, "255");
    EXPECT_EQ(error_of([&] { read(long_list); }).code(), base::ErrorCode::bad_input);
}

TEST(ReadPly, RefusesValuesThatMakeNoMesh) {
    const auto message = [](std::string from, const std::string& to) {
        std::string bytes = ascii;
        bytes.replace(bytes.find(from), from.size(), to);
        return error_of([&] { read(bytes); }).message();
    };
    EXPECT_THAT(message("1 1 0 9", "1 nan 0 9"), HasSubstr("y is nan"));
    EXPECT_THAT(message("1 1 0 9", "1 inf 0 9"), HasSubstr("not a finite number"));
    EXPECT_THAT(message("1 1 0 9", "1 x 0 9"), HasSubstr("\"x\" is not a number"));
    EXPECT_THAT(message("4 0 1 2 3", "4 0 1 2 4"), HasSubstr("names vertex 4"));
    EXPECT_THAT(message("4 0 1 2 3", "4 0 1 2 -1"), HasSubstr("names vertex -1"));
    EXPECT_THAT(message("4 0 1 2 3", "4 0 2 1 3"),
                HasSubstr("face 0: the face crosses itself: its edge from corner 1"));
    EXPECT_THAT(message("property float z", "property float w"), HasSubstr("x, y and z"));
    EXPECT_THAT(message("format ascii", "format base64"), HasSubstr("base64"));
    EXPECT_THAT(message("property uchar red", "property colour red"), HasSubstr("not understood"));
    EXPECT_THAT(message("list uchar int", "list float int"), HasSubstr("not an integer type"));
    EXPECT_THAT(message("element vertex", "element point"), HasSubstr("before the vertices"));
}

TEST(ReadPly, NamesTheLineOfTextAndTheByteOfBinaryNumbers) {
    const auto place = [](std::string bytes, const std::string& from, const std::string& to) {
        bytes.replace(bytes.find(from), from.size(), to);
        const std::string where = error_of([&] { read(bytes); }).where();
        return where.substr(where.rfind(':') + 1);
    };
    EXPECT_EQ(place(ascii, "4 0 1 2 3", "4 0 2 1 3"), "16");
    EXPECT_EQ(place(ascii, "1 1 0 9", "1 x 0 9"), "14");
    EXPECT_EQ(place(ascii, "1 1 0 9", "1 nan 0 9"), "14");
    EXPECT_EQ(place(ascii, "property uchar red", "property colour red"), "8");
    EXPECT_EQ(place(binary(false), "property uchar red", "property colour red"), "8");
    const std::string bytes = binary(false);
    EXPECT_EQ(place(bytes, bytes_of(3), bytes_of(9)), fmt::format(" byte {}", bytes.size()));
}

TEST(ReadPly, ReadsHeadersWithAnyLineEnd) {
    const auto with_ends = [](const std::string& bytes, const std::string& end) {
        const std::size_t header = bytes.find("end_header\n") + 11;
        std::string result;
        for (std::size_t i = 0; i < bytes.size(); ++i)
            result += i < header && bytes[i] == '\n' ? end : bytes.substr(i, 1);
        return result;
    };
    for (const std::string end : {"\r", "\r\n"}) {
        for (const std::string& bytes : {ascii, binary(false), binary(true)})
            EXPECT_EQ(test::area(read(with_ends(bytes, end))), 1.0);
        std::string bad = with_ends(ascii, end);
        bad.replace(bad.find("uchar red"), 5, "colour");
        EXPECT_THAT(error_of([&] { read(bad); }).where(), testing::EndsWith(":8"));
    }
    // The first byte of the numbers is that of a line feed.
    std::string number = strips("binary_little_endian", "int");
    number = with_ends(number, "\r");
    const std::array<Vec3f, 5> at{
        Vec3f(std::bit_cast<float>(0x3f80000a), 0, 0), {0, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, 0}};
    for (const Vec3f& each : at) number += bytes_of(each.x) + bytes_of(each.y) + bytes_of(each.z);
    for (const int index : {3, 0, 1, 2}) number += bytes_of(index);
    EXPECT_EQ(read(number).positions[0].x, at[0].x);
}

// The triangles of the first one would index the vertices of the second.
TEST(ReadPly, RefusesVerticesTwice) {
    std::string twice = ascii;
    twice.insert(twice.find("end_header"), "element vertex 0\nproperty float x\nproperty float y\nproperty float z\n");
    EXPECT_THAT(error_of([&] { read(twice); }).message(), HasSubstr("second element"));
}

// As Blender 2.47 wrote them. A line behind the first element may be a misspelt element: its vertices must not vanish.
TEST(ReadPly, PassesOverCommentsWithoutTheirKeywordAtTheTop) {
    std::string bytes = ascii;
    bytes.insert(bytes.find("element"), "Created by Blender3D 247 - www.blender.org, source file: \n");
    EXPECT_EQ(test::area(read(bytes)), 1.0);
    bytes = ascii;
    bytes.replace(bytes.find("element face"), 7, "elemant");
    EXPECT_THAT(error_of([&] { read(bytes); }).message(), HasSubstr("\"elemant\" is unknown"));
}

TEST(ReadPly, TakesAByteOrderMark) {
    for (const std::string& bytes : {ascii, binary(false), binary(true)})
        EXPECT_EQ(test::area(read("\xef\xbb\xbf" + bytes)), 1.0);
    EXPECT_THAT(error_of([] { read(std::string("\xff\xfep\0l\0y\0", 8)); }).message(), HasSubstr("UTF-8"));
}

TEST(ReadPly, CoversAConcavePolygonOnce) {
    std::string l = header("ascii", "6") + "2 0 0 9\n2 1 0 9\n1 1 0 9\n1 2 0 9\n0 2 0 9\n0 0 0 9\n6 0 1 2 3 4 5\n";
    EXPECT_EQ(test::area(read(l)), 3.0);
}

TEST(ReadPly, PassesOverDegenerateFacesAndUnknownElements) {
    std::string bytes =
        header("ascii", "4", "4") + "0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n2 0 1\n4 0 1 2 3\n0\n4 0 0 1 1\n7 8\n";
    bytes.insert(bytes.find("end_header"), "element edge 1\nproperty int vertex1\nproperty int vertex2\n");
    EXPECT_EQ(read(bytes).triangles.size(), 2u);
    EXPECT_THAT(passed_over(bytes), ElementsAre(Pair("faces of fewer than 3 corners", 2), Pair("faces without area", 1),
                                                Pair("elements \"edge\"", 1)));
    EXPECT_THAT(passed_over(ascii), IsEmpty());
}

TEST(ReadPly, TakesTriangleStripsOfAllEncodings) {
    const std::vector<Vec3f> positions{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}};
    std::string text = strips("ascii", "int"), numbers = std::to_string(strip_list.size());
    for (const Vec3f& at : positions) text += fmt::format("{} {} {}\n", at.x, at.y, at.z);
    for (const int index : strip_list) numbers += " " + std::to_string(index);
    std::vector<std::string> all{text + numbers + "\n"};
    for (const bool big : {false, true})
        for (const char* type : {"int", "uint"}) {
            std::string bytes = strips(big ? "binary_big_endian" : "binary_little_endian", type);
            for (const Vec3f& at : positions) bytes += ordered(at.x, big) + ordered(at.y, big) + ordered(at.z, big);
            bytes += ordered(static_cast<int>(strip_list.size()), big);
            for (const int index : strip_list) bytes += ordered(index, big);
            all.push_back(bytes);
        }
    for (const std::string& bytes : all) {
        // All turn one way within a strip: every second triangle is listed the other way round.
        EXPECT_THAT(read(bytes).triangles, ElementsAre(Vec3i(0, 1, 3), Vec3i(3, 1, 2), Vec3i(1, 2, 4), Vec3i(1, 4, 3)));
        EXPECT_THAT(passed_over(bytes), ElementsAre(Pair("strips of fewer than 3 vertices", 1)));
    }
}

TEST(ReadPly, RefusesStripsOfVerticesThatDoNotExist) {
    for (const char* index : {"4", "-2", "0.5", "nan"})
        EXPECT_THAT(
            error_of([&] {
                read(
                    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
                    "z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 "
                    "0\n3 0 1 " +
                    std::string(index) + "\n");
            }).message(),
            HasSubstr("tristrips 0 names vertex"));
}

TEST(ReadPly, ReadsAFileOfOnlyVertices) {
    const Mesh mesh = read(
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
        "end_header\n0 1 0\n1 1 0\n");
    EXPECT_EQ(mesh.positions.size(), 2u);
    EXPECT_THAT(mesh.triangles, IsEmpty());
}

// Nothing in the file bounds how many of them there are: counting to the largest number in turn would take days.
TEST(ReadPly, DoesNotCountElementsWithoutProperties) {
    std::string many;
    for (int i = 0; i < 100'000; ++i) many += "element nothing 200000000\n";
    std::string bytes = ascii;
    bytes.insert(bytes.find("element vertex"), many);
    EXPECT_EQ(read(bytes).triangles.size(), 2u);
}

// More text than the reader holds at a time: numbers lie across the ends of its parts.
TEST(ReadPly, ReadsLongTexts) {
    constexpr int vertices = 40000;
    std::string text = header("ascii", std::to_string(vertices), std::to_string(vertices));
    for (int i = 0; i < vertices; ++i) text += fmt::format("{} 0.5 -{} 9\n", i, i);
    for (int i = 0; i < vertices; ++i) text += fmt::format("3 {} {} {}\n", i, (i + 1) % vertices, (i + 2) % vertices);
    const Mesh mesh = read(text);
    ASSERT_EQ(mesh.triangles.size(), static_cast<std::size_t>(vertices));
    for (int i = 0; i < vertices; ++i) {
        const auto at = static_cast<std::size_t>(i);
        ASSERT_EQ(mesh.positions[at], Vec3f(static_cast<float>(i), 0.5f, -static_cast<float>(i)));
        ASSERT_EQ(mesh.triangles[at], Vec3i(i, (i + 1) % vertices, (i + 2) % vertices));
    }
    // The header has 11 lines.
    text.replace(text.size() - 2, 1, "x");
    EXPECT_THAT(error_of([&] { read(text); }).where(), testing::EndsWith(fmt::format(":{}", 11 + 2 * vertices)));
}

TEST(ReadPly, UnpacksFiles) {
    const auto read_packed = [](const std::string& bytes) {
        return read_ply(test::write_file("a.ply.gz", bytes)).mesh;
    };
    const std::string packed = test::packed(ascii + std::string(1 << 20, ' '), 16 + 15);
    EXPECT_THAT(read_packed(packed).triangles, ElementsAre(Vec3i(0, 1, 2), Vec3i(0, 2, 3)));
    std::string damaged = packed;  // in the sum of what follows the faces
    damaged[damaged.size() - 8] = static_cast<char>(damaged[damaged.size() - 8] ^ 1);
    EXPECT_EQ(error_of([&] { read_packed(damaged); }).code(), base::ErrorCode::bad_input);
    std::string more = packed;
    more.replace(more.size() - 4, 4, bytes_of(static_cast<std::uint32_t>(ascii.size())));
    EXPECT_THAT(error_of([&] { read_packed(more); }).message(), HasSubstr("more content"));
}

}  // namespace
}  // namespace shadowbench::scene
