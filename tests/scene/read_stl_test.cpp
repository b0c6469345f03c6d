#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scene/readers/files.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::bytes_of;
using test::error_of;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

using Facet = std::array<Vec3f, 3>;

// The unit cube, each face as two facets that turn counter-clockwise as seen from outside.
std::vector<Facet> cube() {
    const auto at = [](int corner) {
        return Vec3f(static_cast<float>(corner & 1), static_cast<float>((corner >> 1) & 1),
                     static_cast<float>(corner >> 2));
    };
    std::vector<Facet> facets;
    for (const auto& [a, b, c, d] :
         {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
        facets.push_back({at(a), at(b), at(c)});
        facets.push_back({at(a), at(c), at(d)});
    }
    return facets;
}

std::string text_of(const Facet& facet) {
    std::string text = "  facet normal 0 0 0\n    outer loop\n";
    for (const Vec3f& at : facet) text += fmt::format("      vertex {} {} {}\n", at.x, at.y, at.z);
    return text + "    endloop\n  endfacet\n";
}

std::string text_of(const std::vector<Facet>& facets) {
    std::string text = "solid made by hand\n";
    for (const Facet& facet : facets) text += text_of(facet);
    return text + "endsolid made by hand\n";
}

// With attributes that are not 0, and a normal that is no number.
std::string binary_of(const std::vector<Facet>& facets, const std::string& header = "made by hand") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::string bytes = header;
    bytes.resize(80, '\0');
    bytes += bytes_of(static_cast<std::uint32_t>(facets.size()));
    for (const Facet& facet : facets) {
        bytes += bytes_of(nan, nan, nan);
        for (const Vec3f& at : facet) bytes += bytes_of(at.x, at.y, at.z);
        bytes += bytes_of(std::uint16_t{0x8421});
    }
    return bytes;
}

MeshFile read_file(const std::string& bytes) {
    return read_mesh(test::write_file("a.stl", bytes));
}

Mesh read(const std::string& bytes) {
    return read_file(bytes).mesh;
}

std::vector<std::pair<std::string, std::uint64_t>> passed_over(const std::string& bytes) {
    std::vector<std::pair<std::string, std::uint64_t>> list;
    for (const PassedOver& each : read_file(bytes).passed_over) list.emplace_back(each.what, each.count);
    return list;
}

// The volume that the triangles enclose: above 0 if they turn counter-clockwise as seen from outside.
double volume(const Mesh& mesh) {
    double sum = 0.0;
    const auto at = [&](int index) { return Vec3d(mesh.positions.at(static_cast<std::size_t>(index))); };
    for (const Vec3i& t : mesh.triangles) sum += at(t.x).dot(at(t.y).cross(at(t.z))) / 6.0;
    return sum;
}

// Without merging, the cube would have 36 vertices.
TEST(ReadStl, ReadsACubeOfBothEncodingsAlike) {
    for (const std::string& bytes : {text_of(cube()), binary_of(cube())}) {
        const Mesh mesh = read(bytes);
        EXPECT_EQ(mesh.positions.size(), 8u);
        EXPECT_EQ(mesh.triangles.size(), 12u);
        EXPECT_EQ(test::area(mesh), 6.0);
        EXPECT_NEAR(volume(mesh), 1.0, 1e-12);
        EXPECT_THAT(passed_over(bytes), IsEmpty());
    }
    const Mesh text = read(text_of(cube())), binary = read(binary_of(cube()));
    EXPECT_EQ(text.positions, binary.positions);
    EXPECT_EQ(text.triangles, binary.triangles);
}

// More triangles than are read at once, each at its own place.
TEST(ReadStl, KeepsTheOrderOfManyTriangles) {
    std::vector<Facet> facets;
    for (int i = 0; i < 140'000; ++i) {
        const auto x = static_cast<float>(i * 7919 % 140'000);
        facets.push_back({Vec3f(x, 0, 0), Vec3f(x, 1, 0), Vec3f(x, 0, 1)});
    }
    const Mesh mesh = read(binary_of(facets));
    ASSERT_EQ(mesh.triangles.size(), facets.size());
    EXPECT_EQ(mesh.positions.size(), 3 * facets.size());
    for (std::size_t i = 0; i < facets.size(); ++i)
        for (int corner = 0; corner < 3; ++corner)
            ASSERT_EQ(mesh.positions[static_cast<std::size_t>(mesh.triangles[i][corner])],
                      facets[i][static_cast<std::size_t>(corner)])
                << i;
}

TEST(ReadStl, MergesEqualPositionsAndNoOthers) {
    const float next = std::nextafter(1.0f, 2.0f);
    const std::vector<Facet> facets{{Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0)},
                                    {Vec3f(-0.0f, 0, -0.0f), Vec3f(next, 0, 0), Vec3f(0, 1, 0)}};
    EXPECT_EQ(read(binary_of(facets)).positions.size(), 4u);
    EXPECT_EQ(read(text_of(facets)).positions.size(), 4u);
}

TEST(ReadStl, CountsTrianglesWithoutAreaAndBytesAtTheEnd) {
    std::vector<Facet> facets = cube();
    facets.insert(facets.begin() + 5, Facet{Vec3f(1, 2, 3), Vec3f(4, 5, 6), Vec3f(1, 2, 3)});
    for (const std::string& bytes : {text_of(facets), binary_of(facets)}) {
        EXPECT_EQ(test::area(read(bytes)), 6.0);
        EXPECT_THAT(passed_over(bytes), ElementsAre(Pair("faces without area", 1)));
    }
    EXPECT_THAT(passed_over(binary_of(cube()) + std::string(70, 'x')),
                ElementsAre(Pair("bytes after the last triangle", 70)));
}

// Some programs begin the header of a binary file as a text begins.
TEST(ReadStl, TellsTextAndBinaryApart) {
    for (const char* header : {"solid", "solid made by hand", "  solid\n", "SOLID"})
        EXPECT_EQ(read(binary_of(cube(), header)).triangles.size(), 12u) << header;
    std::string spaces = "solid ";
    spaces.resize(80, ' ');
    EXPECT_EQ(read(binary_of(cube(), spaces)).triangles.size(), 12u);
}

TEST(ReadStl, TakesTextAsProgramsWriteIt) {
    const std::string text = text_of(cube());
    const auto replaced = [&](const std::string& from, const std::string& to) {
        std::string result;
        for (std::size_t at = 0; at < text.size();)
            if (text.compare(at, from.size(), from) == 0) {
                result += to;
                at += from.size();
            } else {
                result += text[at++];
            }
        return result;
    };
    std::string capitals = text;
    std::transform(text.begin(), text.end(), capitals.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    for (const std::string& bytes :
         {capitals, replaced("\n", "\r\n"), replaced("\n", "\r"), replaced("\n", "\n\n"), replaced(" ", "\t"),
          replaced("normal 0 0 0", "normal nan nan nan"), replaced("1", "+1e0"), replaced("made by hand", ""),
          replaced("made by hand", "facet vertex"), "\xef\xbb\xbf" + text, "\n " + text,
          text.substr(0, text.size() - 1)}) {
        const Mesh mesh = read(bytes);
        EXPECT_EQ(mesh.positions.size(), 8u) << bytes.substr(0, 200);
        EXPECT_EQ(test::area(mesh), 6.0) << bytes.substr(0, 200);
    }
    EXPECT_EQ(test::area(read(text + text)), 12.0) << "a file may hold several solids";
    EXPECT_THAT(passed_over(replaced("    endloop\n", "    endloop\n  colour 1 0 0\n")),
                ElementsAre(Pair("lines of the unknown keyword \"colour\"", 12)));
}

TEST(ReadStl, TellsTheLineOfWhatIsWrongInAText) {
    const std::string first = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n",
                      last = "endloop\nendfacet\nendsolid\n";
    ASSERT_EQ(read(first + "vertex 0 1 0\n" + last).triangles.size(), 1u);
    const auto message = [](const std::string& text, int line) {
        const base::Error error = error_of([&] { read(text); });
        EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
        EXPECT_THAT(error.where(), EndsWith(fmt::format("a.stl:{}", line)));
        return error.message();
    };
    EXPECT_THAT(message(first + "vertex 0 nan 0\n" + last, 6), HasSubstr("\"nan\" is not a finite number"));
    EXPECT_THAT(message(first + "vertex 0 1e39 inf\n" + last, 6), HasSubstr("not a finite number"));
    EXPECT_THAT(message(first + "vertex 0 1 x\n" + last, 6), HasSubstr("\"x\""));
    EXPECT_THAT(message(first + "vertex 0 1\n" + last, 6), HasSubstr("2 numbers"));
    EXPECT_THAT(message(first + "vertex 0 1 0 1\n" + last, 6), HasSubstr("4 numbers"));
    EXPECT_THAT(message(first + last, 7), HasSubstr("2 vertices"));
    EXPECT_THAT(message(first + "vertex 0 1 0\nvertex 1 1 0\n" + last, 7), HasSubstr("more than 3"));
    EXPECT_THAT(message(first + "facet normal 0 0 1\n" + last, 6), HasSubstr("facet stands in a facet"));
    EXPECT_THAT(message("solid\nvertex 0 0 0\nendsolid\n", 2), HasSubstr("vertex stands in a solid"));
    EXPECT_THAT(message("solid\nendsolid\nfacet normal 0 0 1\n", 3), HasSubstr("outside of a solid"));
    EXPECT_THAT(message("solid\n<b>\nendsolid\n", 2), HasSubstr("not an STL file"));
    EXPECT_THAT(message("solid\n", 1), HasSubstr("before endsolid"));
}

TEST(ReadStl, TellsTheByteOfANumberThatIsNotFinite) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity(), 1e30f}) {
        std::vector<Facet> facets = cube();
        facets[3][2].y = bad;
        const base::Error error = error_of([&] { read(binary_of(facets)); });
        EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
        EXPECT_THAT(error.where(), EndsWith(fmt::format("byte {}", 84 + 3 * 50 + 12 + 2 * 12 + 4)));
        EXPECT_THAT(error.message(), HasSubstr("triangle 3"));
    }
}

TEST(ReadStl, RefusesCountsTheFileCannotHoldBeforeMemoryIsTaken) {
    for (const std::uint32_t count : {13u, 200'000'000u, 0xffffffffu}) {
        std::string bytes = binary_of(cube());
        bytes.replace(80, 4, bytes_of(count));
        const base::Error error = error_of([&] { read(bytes); });
        EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
        EXPECT_THAT(error.where(), EndsWith("byte 80"));
        EXPECT_THAT(error.message(), HasSubstr(fmt::format("{} triangles of 50 bytes, but 600 bytes follow", count)));
    }
}

TEST(ReadStl, RefusesAFileCutAnywhere) {
    const auto read_cut = [](const std::filesystem::path& file) { read_mesh(file); };
    const std::string text = text_of(cube()), binary = binary_of(cube());
    test::expect_cuts_refused(binary, "cut.stl", binary.size(), read_cut);
    // The name at the end may be missing.
    test::expect_cuts_refused(text, "cut.stl", text.find("endsolid") + 8, read_cut);
}

TEST(ReadStl, SaysWhenAFileIsOfAnotherFormat) {
    std::string long_text;
    for (int i = 0; i < 100; ++i) long_text += "v 0 0 0\n";
    for (const std::string& other : {std::string(), std::string("v 0 0 0\n"), long_text, std::string(84, '\xff'),
                                     std::string("ply\nformat ascii 1.0\n")})
        EXPECT_THAT(error_of([&] { read(other); }).message(), HasSubstr("not an STL file")) << other;
    EXPECT_EQ(error_of([] { read_mesh("/nowhere/a.stl"); }).code(), base::ErrorCode::no_such_file);
}

TEST(ReadStl, AFileWithoutTrianglesIsAnEmptyMesh) {
    for (const std::string& bytes : {text_of(std::vector<Facet>{}), binary_of({})})
        EXPECT_THAT(read(bytes).triangles, IsEmpty());
}

}  // namespace
}  // namespace shadowbench::scene
