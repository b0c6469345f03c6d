// Strands for Mitsuba, against values written by hand, and curves against their closed forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "scene/readers/hair_files.h"
#include "scene/readers/strands.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::bytes_of;
using test::error_of;
using testing::ElementsAre;
using testing::HasSubstr;

HairFile read(const std::string& text, float radius = 0.0f, CurveBasis basis = CurveBasis::linear) {
    return read_strands(test::write_file("strands.txt", text), radius, basis);
}

TEST(ReadMitsubaHair, EmptyLinesDivideStrands) {
    const HairFile file = read("\n1 2 3\r\n4 5 6\n\n \t\n7 8 9\n10 11 12\n13 14 15");
    EXPECT_THAT(file.hair.strand_begin, ElementsAre(0u, 2u, 5u));
    EXPECT_EQ(file.hair.points[4], Vec3f(13, 14, 15));
    EXPECT_FALSE(file.has_radii);
}

// Mitsuba's radius is a half-width, as ours.
TEST(ReadMitsubaHair, TakesTheRadiusOfEachPoint) {
    const std::string text = "0 0 0 0.5\n1 0 0 0.25\n";
    EXPECT_THAT(read(text).hair.radii, ElementsAre(0.5f, 0.25f));
    EXPECT_TRUE(read(text).has_radii);
    EXPECT_THAT(read(text, 2.0f).hair.radii, ElementsAre(2.0f, 2.0f)) << "a radius given overrides them";
}

std::string binary(std::uint32_t count) {
    const float end = std::numeric_limits<float>::infinity();
    return "BINARY_HAIR" + bytes_of(count, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, end, 7.0f, 8.0f, 9.0f, 0.0f, 1.0f, 2.0f);
}

TEST(ReadMitsubaHair, ReadsTheBinaryForm) {
    const auto file = test::write_file("binary.hair", binary(4));
    ASSERT_TRUE(is_mitsuba_hair(file));
    const HairFile strands = read_strands(file, 0.5f);
    EXPECT_THAT(strands.hair.strand_begin, ElementsAre(0u, 2u, 4u));
    EXPECT_EQ(strands.hair.points[2], Vec3f(7, 8, 9));
    EXPECT_THAT(strands.hair.radii, testing::Each(0.5f));
    EXPECT_FALSE(strands.has_radii);
    test::expect_cuts_refused(binary(4), "cut.hair", binary(4).size(),
                              [](const auto& cut) { read_mitsuba_hair(cut, 1.0f); });
    const auto message = [](std::uint32_t count) {
        return error_of([&] { read_strands(test::write_file("count.hair", binary(count)), 1.0f); }).message();
    };
    EXPECT_THAT(message(0xffffffffu), HasSubstr("the limit is"));
    EXPECT_THAT(message(100'000'000u), HasSubstr("too short"));
}

TEST(ReadMitsubaHair, IsKnownByItsFirstBytes) {
    const auto is = [](const std::string& text) { return is_mitsuba_hair(test::write_file("kind.hair", text)); };
    EXPECT_TRUE(is("\n\n-1 2 3\n"));
    EXPECT_FALSE(is("HAIR" + std::string(124, '\0')));
    EXPECT_FALSE(is("something else"));
    EXPECT_FALSE(is(""));
}

TEST(ReadMitsubaHair, RefusesWhatIsNoPointWithItsLine) {
    const auto refused = [](const std::string& text) { return error_of([&] { read(text); }); };
    EXPECT_THAT(refused("0 0 0\n0 x 0\n").where(), HasSubstr("strands.txt:2"));
    EXPECT_THAT(refused("0 0 0\n0 x 0\n").message(), HasSubstr("\"x\" does not belong to a point"));
    EXPECT_THAT(refused("0 0 0 1 2\n").message(), HasSubstr("\"2\" does not belong"));
    EXPECT_THAT(refused("0 0\n").message(), HasSubstr("2 numbers"));
    EXPECT_THAT(refused("0 0 0\n0 0 0 1\n").message(), HasSubstr("4 numbers, but the points before have 3"));
    EXPECT_THAT(refused("0 0 0 -1\n").message(), HasSubstr("below 0"));
    EXPECT_THAT(refused("0 0 inf\n").message(), HasSubstr("\"inf\""));
    EXPECT_THAT(refused("\n\n").message(), HasSubstr("no points"));
}

// A parabola: the middle of a segment is where straight lines between the points would miss it most.
TEST(ReadMitsubaHair, SplinesAreCurves) {
    const std::string text = "-1 1 0 0.1\n0 0 0 0.1\n1 1 0 0.1\n2 4 0 0.1\n\n0 0 0 1\n1 0 0 1\n";
    const HairFile file = read(text, 0.0f, CurveBasis::bspline);
    // A cubic B-spline through x^2 at integers is x^2 + 1/3, from x = 0 to 1.
    ASSERT_EQ(file.hair.strand_begin.size(), 2u);
    EXPECT_FLOAT_EQ(file.hair.points.front().y, 1.0f / 3.0f);
    EXPECT_FLOAT_EQ(file.hair.points.back().x, 1.0f);
    EXPECT_GT(file.hair.points.size(), 3u);
    for (const Vec3f& point : file.hair.points) EXPECT_NEAR(point.y, point.x * point.x + 1.0f / 3.0f, 1e-6f);
    for (const float radius : file.hair.radii) EXPECT_FLOAT_EQ(radius, 0.1f);
    ASSERT_EQ(file.passed_over.size(), 1u);
    EXPECT_EQ(file.passed_over[0].what, "splines of fewer than 4 points");
}

// The largest distance from a curve to the segments that stand for it.
double distance(const Hair& hair, const CubicCurve& curve) {
    double largest = 0.0;
    for (int i = 0; i <= 1000; ++i) {
        const Vec3d at = point_on(curve, i / 1000.0).at;
        double nearest = 1e30;
        for (std::size_t s = 0; s + 1 < hair.points.size(); ++s) {
            const Vec3d a(hair.points[s]), edge = Vec3d(hair.points[s + 1]) - a;
            const double t = std::clamp((at - a).dot(edge) / edge.length2(), 0.0, 1.0);
            nearest = std::min(nearest, (a + edge * t - at).length());
        }
        largest = std::max(largest, nearest);
    }
    return largest;
}

TEST(Strands, SegmentsLeaveACurveByAQuarterOfItsHalfWidth) {
    for (const double radius : {0.5, 0.05, 0.005}) {
        const CubicCurve curve{
            {{{0, 0, 0}, radius}, {{0, 1, 0}, radius}, {{1, 1, 1}, radius}, {{1, 0, 2}, radius / 2}}};
        Strands strands;
        strands.begin(curve[0]);
        strands.curve_to(curve);
        const Hair hair = std::move(strands).finish();
        EXPECT_LE(distance(hair, curve), 0.25 * radius + 1e-7);
        EXPECT_LE(hair.points.size(), 65u);
        EXPECT_EQ(hair.points.back(), Vec3f(1, 0, 2));
    }
    // A straight curve needs one segment, however thin it is.
    Strands straight;
    straight.begin({{0, 0, 0}, 1e-6});
    straight.curve_to({{{{0, 0, 0}, 1e-6}, {{1, 0, 0}, 1e-6}, {{2, 0, 0}, 1e-6}, {{3, 0, 0}, 1e-6}}});
    EXPECT_EQ(straight.points(), 2u);
}

}  // namespace
}  // namespace shadowbench::scene
