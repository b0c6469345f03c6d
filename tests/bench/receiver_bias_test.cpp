// Slope-scaled and normal-offset bias, against closed forms of a plane.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/queries.h"

namespace shadowbench::bench {
namespace {

using base::Vec3d;
using rays::LightView;

// Looks along -y of the world, its x along the world's x: depth is 10 - y, and a map pixel is 1/8 wide.
LightView from_above() {
    LightView view;
    view.origin = {0, 10, 0};
    view.right = {1, 0, 0};
    view.up = {0, 0, -1};
    view.forward = {0, -1, 0};
    view.lower = {-4, -4};
    view.pixel = {0.125, 0.125};
    view.resolution = {64, 64};
    view.z_near = -std::numeric_limits<double>::infinity();
    view.z_min = -100.0;
    view.z_max = 100.0;
    return view;
}

// The same from a point: slopes reach from -1 to 1.
LightView from_a_point() {
    LightView view = from_above();
    view.perspective = true;
    view.lower = {-1, -1};
    view.pixel = {1.0 / 32, 1.0 / 32};
    view.z_near = 0.01;
    view.z_min = 1.0;
    return view;
}

// The plane through a point of the world with this normal.
struct Plane {
    Vec3d point, normal;

    Vec3d at(const LightView& view, double x, double y) const {  // where the light ray at (x, y) meets it
        const rays::LightLine line = rays::light_line(view, x, y);
        return line.origin + line.direction * (normal.dot(point - line.origin) / normal.dot(line.direction));
    }
    double depth(const LightView& view, double x, double y) const { return rays::to_light(view, at(view, x, y)).z; }
};

// A plane whose depth grows by `x` and `y` over a map pixel of the view from above.
Plane sloped(double x, double y) {
    return {{0, 5, 0}, Vec3d(x, 0.125, -y).normalized()};
}

scene::Receivers with(double slope_bias, double normal_bias) {
    scene::Receivers receivers;
    receivers.slope_bias = slope_bias;
    receivers.normal_bias = normal_bias;
    return receivers;
}

// How far the receivers that are looked up in map pixel (20, 30) at most lie behind the sample in the pixel's middle:
// above 0 they shadow themselves.
double acne(const Plane& plane, const scene::Receivers& receivers) {
    const LightView view = from_above();
    double most = -std::numeric_limits<double>::infinity();
    for (int j = -20; j < 40; ++j)
        for (int i = -20; i < 40; ++i) {
            const Vec3d place = plane.at(view, 20.0 + (i + 0.5) / 20.0, 30.0 + (j + 0.5) / 20.0);
            const auto query = query_of_point({place, {}, {}, plane.normal}, receivers, view);
            if (!query || std::floor(query->x) != 20.0f || std::floor(query->y) != 30.0f) continue;
            most = std::max(most, static_cast<double>(query->z) - plane.depth(view, 20.5, 30.5));
        }
    return most;
}

// The receivers of a pixel lie up to half a pixel from its middle, so a slope s along x takes s / 2.
TEST(SlopeBias, RemovesTheAcneOfAPlaneExactlyAtHalfAPixel) {
    for (const double slope : {0.01, 0.2, -0.2, 3.0}) {
        EXPECT_GT(acne(sloped(slope, 0), with(0, 0)), 0.47 * std::abs(slope)) << "the acne that is to be removed";
        EXPECT_GT(acne(sloped(slope, 0), with(0.47, 0)), 0.0) << slope;
        EXPECT_LE(acne(sloped(slope, 0), with(0.5, 0)), 1e-5) << slope;
        EXPECT_GT(acne(sloped(0, slope), with(0.47, 0)), 0.0) << slope;
        EXPECT_LE(acne(sloped(0, slope), with(0.5, 0)), 1e-5) << slope;
    }
    // The larger of two equal slopes is half of their sum.
    EXPECT_GT(acne(sloped(0.25, 0.25), with(0.94, 0)), 0.0);
    EXPECT_LE(acne(sloped(0.25, 0.25), with(1.0, 0)), 1e-5);
}

// An offset h along the normal brings the receiver h / cos t before the plane along the light, and a slope of angle t
// takes w tan t / 2 for pixels of width w: h = w sin t / 2.
TEST(NormalBias, RemovesTheAcneOfAPlaneExactlyAtHalfAPixel) {
    for (const double slope : {0.01, 0.2, -0.2, 3.0}) {
        EXPECT_GT(acne(sloped(slope, 0), with(0, 0.44)), 0.0) << slope;
        EXPECT_LE(acne(sloped(slope, 0), with(0, 0.5)), 1e-5) << slope;
        const Plane from_below{sloped(slope, 0).point, -sloped(slope, 0).normal};
        EXPECT_LE(acne(from_below, with(0, 0.5)), 1e-5) << "the camera is on the other side";
    }
    const LightView view = from_above();
    const Vec3d place(0, 5, 0);
    const auto facing = query_of_point({place, {}, {}, {0, 1, 0}}, with(7, 7), view);
    EXPECT_EQ(facing->z, 5.0f) << "a plane across the light needs no bias";
    const double angle = 0.3;
    const auto moved = query_of_point({place, {}, {}, {std::sin(angle), std::cos(angle), 0}}, with(0, 2), view);
    EXPECT_NEAR(moved->z, 5.0 - 2 * 0.125 * std::sin(angle) * std::cos(angle), 1e-5);
    EXPECT_NEAR(moved->x, 32.0 + 2 * std::sin(angle) * std::sin(angle), 1e-5);
}

// In perspective, against differences of the plane's own depth.
TEST(SlopeBias, TakesTheSlopeOverAMapPixelInPerspective) {
    const LightView view = from_a_point();
    for (const Vec3d& normal : {Vec3d(0.3, 1, 0.1), Vec3d(-0.5, 1, 0.7), Vec3d(0, 1, 0), Vec3d(1, 0.2, 0.1)}) {
        const Plane plane{{0, 3, 0}, normal.normalized()};
        for (const double x : {28.3, 31.9, 40.0}) {
            constexpr double step = 1e-5;
            const double y = 33.7, depth = plane.depth(view, x, y);
            if (!(depth > 1.0 && depth < 100.0)) continue;
            const auto along = [&](double dx, double dy) {
                return std::abs(plane.depth(view, x + dx, y + dy) - plane.depth(view, x - dx, y - dy)) / (2 * step);
            };
            const double slope = std::max(along(step, 0), along(0, step));
            const auto query = query_of_point({plane.at(view, x, y), {}, {}, plane.normal}, with(0.25, 0), view);
            ASSERT_TRUE(query);
            EXPECT_NEAR(query->z, std::max(depth - 0.25 * slope, 1.0), 1e-5 * depth);
        }
    }
    // 7 deep, a pixel is 7/32 wide.
    const double s = std::sqrt(0.5);
    const auto moved = query_of_point({{0, 3, 0}, {}, {}, {s, s, 0}}, with(0, 1), view);
    EXPECT_NEAR(moved->z, 7.0 - 0.5 * 7.0 / 32, 1e-5);
}

// A slope without bound: before all casters everything is lit, so there the point stays, and in the map.
TEST(SlopeBias, KeepsSurfacesThatTheLightGrazes) {
    for (LightView view : {from_above(), from_a_point()}) {
        view.z_min = 1.0;
        const auto grazed = query_of_point({{0, 5, 0}, {}, {}, {1, 0, 0}}, with(1, 0), view);
        ASSERT_TRUE(grazed);
        EXPECT_EQ(grazed->z, 1.0f);
        const auto before = query_of_point({{0, 9.5, 0}, {}, {}, {1, 0, 0}}, with(1, 0), view);
        ASSERT_TRUE(before);
        EXPECT_EQ(before->z, 0.5f) << "what is before all casters already does not move back";
    }
    LightView near = from_a_point();
    near.z_min = near.z_near;
    EXPECT_TRUE(query_of_point({{0, 5, 0}, {}, {}, {1, 0, 0}}, with(1, 0), near)) << "z_near itself is not seen";
}

TEST(SlopeBias, LeavesPointsWithoutANormalWhereTheyAre) {
    const auto query = query_of_point({{0.3, 5, 0}}, with(4, 4), from_above());
    EXPECT_EQ(query->z, 5.0f);
    EXPECT_FLOAT_EQ(query->x, 34.4f);
}

TEST(Softness, IsTheWidthOfTheLightsLookups) {
    scene::Receivers receivers;
    receivers.filter_width.value = 3.0;
    const LightView view = from_above();
    EXPECT_EQ(query_of_point({{0, 5, 0}}, receivers, view)->width, 3.0f);
    const scene::FilterWidth soft{scene::WidthUnit::length, 0.5};
    EXPECT_EQ(query_of_point({{0, 5, 0}}, receivers, view, soft)->width, 4.0f) << "of pixels of 1/8";
    scene::Scenario scenario;
    scenario.receivers = receivers;
    scene::Light light;
    light.softness = scene::FilterWidth{scene::WidthUnit::share, 0.25};
    const std::vector<CameraPoint> seen{{{0, 5, 0}}};
    for (const int kind : {0, 1, 2}) {  // probes, points, a camera
        scenario.receivers.count = 10;
        scenario.receivers.points.assign(kind == 1, {0, 5, 0});
        scenario.receivers.camera = kind == 2 ? std::optional(scene::Camera{}) : std::nullopt;
        for (const techniques::Query& query : scenario_queries(scenario, light, seen, view).queries)
            EXPECT_EQ(query.width, 16.0f) << kind;
    }
}

}  // namespace
}  // namespace shadowbench::bench
