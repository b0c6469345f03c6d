// Point clouds in PLY files, against values written by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "scene/readers/files.h"
#include "scene/readers/kinds.h"
#include "scene/readers/point_files.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::bytes_of;
using test::error_of;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string position = "property float x\nproperty float y\nproperty float z\n";

std::string cloud(const std::string& columns, const std::string& rows, const char* count = "2") {
    return std::string("ply\nformat ascii 1.0\nelement vertex ") + count + "\n" + columns + "end_header\n" + rows;
}

PointFile read(const std::string& text, float radius = 0.0f) {
    return read_points(test::write_file("points.ply", text), radius);
}

TEST(ReadPoints, TakesPositionsFromColumnsInAnyOrder) {
    const PointFile file = read(
        cloud("property float z\nproperty uchar red\nproperty double x\nproperty float y\n", "3 255 1 2\n6 255 4 5\n"),
        0.5f);
    EXPECT_THAT(file.points.centres, ElementsAre(Vec3f(1, 2, 3), Vec3f(4, 5, 6)));
    EXPECT_THAT(file.points.radii, ElementsAre(0.5f, 0.5f));
    EXPECT_THAT(file.points.density, ElementsAre(1.0f, 1.0f));
    EXPECT_FALSE(file.has_radii);
}

// A width taken for a radius would make every shadow four times as large.
TEST(ReadPoints, TakesTheRadiiThatToolsWrite) {
    for (const auto& [name, first] : {std::pair{"radius", 0.5f}, {"pscale", 0.5f}, {"width", 0.25f}}) {
        const PointFile file = read(
            cloud(position + "property float " + name + "\nproperty float density\n", "0 0 0 0.5 3\n1 0 0 0.25 0\n"));
        EXPECT_TRUE(file.has_radii) << name;
        EXPECT_THAT(file.points.radii, ElementsAre(first, first / 2)) << name;
        EXPECT_THAT(file.points.density, ElementsAre(3.0f, 0.0f));
    }
    const std::string radii = cloud(position + "property float radius\n", "0 0 0 0.5\n1 0 0 7\n");
    EXPECT_THAT(read(radii, 2.0f).points.radii, ElementsAre(2.0f, 2.0f)) << "a radius given overrides them";
}

TEST(ReadPoints, CountsPointsOfRadius0AndOtherElements) {
    const PointFile file = read(
        "ply\nformat ascii 1.0\nelement vertex 2\n" + position +
        "property float radius\nelement camera 2\nproperty list uchar int ids\nend_header\n0 0 0 0\n1 0 0 7\n1 5\n0\n");
    EXPECT_THAT(file.points.centres, ElementsAre(Vec3f(1, 0, 0)));
    ASSERT_EQ(file.passed_over.size(), 2u);
    EXPECT_EQ(file.passed_over[0].what, "points of radius 0");
    EXPECT_EQ(file.passed_over[0].count, 1u);
    EXPECT_EQ(file.passed_over[1].what, "elements \"camera\"");
    EXPECT_EQ(file.passed_over[1].count, 2u);
}

TEST(ReadPoints, ReadsBinaryAndRefusesItCutAnywhere) {
    const std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex 2\n" + position + "end_header\n" +
                              bytes_of(1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f);
    EXPECT_THAT(read(bytes, 1.0f).points.centres, ElementsAre(Vec3f(1, 2, 3), Vec3f(4, 5, 6)));
    test::expect_cuts_refused(bytes, "cut.ply", bytes.size(), [](const auto& file) { read_points(file, 1.0f); });
}

TEST(ReadPoints, RefusesWhatIsNoNumberInRange) {
    const auto message = [](const std::string& text) { return error_of([&] { read(text); }).message(); };
    const std::string radii = position + "property float radius\n";
    EXPECT_THAT(message(cloud(position, "0 0 0\n0 nan 0\n")), HasSubstr("point 1: y is nan"));
    EXPECT_THAT(message(cloud(position, "0 0 0\n0 1e30 0\n")), HasSubstr("point 1: y is 1e+30"));
    EXPECT_THAT(message(cloud(radii, "0 0 0 1\n0 0 0 -1\n")), HasSubstr("point 1: radius is -1"));
    EXPECT_THAT(message(cloud("property float x\n", "0\n0\n")), HasSubstr("need the numbers x, y and z"));
    EXPECT_THAT(message(cloud(position, "", "4000000000")), HasSubstr("the limit is"));
    EXPECT_THAT(message(cloud(position, "", "100000000")), HasSubstr("too short"));
}

// A mesh that is taken for points loses its faces; points that are taken for a mesh are refused as one.
TEST(ReadPoints, KnowsAPointCloudByItsHeader) {
    const auto is = [](const std::string& text) { return is_point_cloud(test::write_file("kind.ply", text)); };
    EXPECT_TRUE(is(cloud(position, "")));
    EXPECT_TRUE(is("ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nelement face 0\r\nend_header\r\n"));
    EXPECT_FALSE(is("ply\nformat ascii 1.0\nelement vertex 1\nelement face 1\nend_header\n"));
    EXPECT_FALSE(is("ply\nformat ascii 1.0\nelement vertex 4\nelement tristrips 1\nend_header\n"));
    EXPECT_FALSE(is("ply\nformat ascii 1.0\nelement vertex 0\nend_header\n"));
    EXPECT_FALSE(is("ply\nelement vertex 4\n")) << "no end of the header";
    EXPECT_FALSE(is_point_cloud("nowhere.ply"));
}

}  // namespace
}  // namespace shadowbench::scene
