// Footprints in light space: maps of any resolution answer the same question.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bench/queries.h"
#include "bench/reference.h"

namespace shadowbench::bench {
namespace {

using base::Vec3d;
using scene::WidthUnit;

// An opaque half-plane at height 0, whose edge runs through the world's y axis at an angle, over a floor at y = -2 that
// casts no shadow. A directional light looks straight down on [-1, 1] x [-1, 1]; a spot light stands at y = 4.
struct HalfPlane {
    scene::Scene scene;
    double nx, nz;  // normal of the edge, towards the lit side

    explicit HalfPlane(double angle) : nx(std::cos(angle)), nz(std::sin(angle)) {
        scene::Mesh mesh;
        const double far = 50.0;
        const Vec3d along{-nz, 0, nx}, away{-nx, 0, -nz};
        for (const auto& [a, b] : {std::pair{-far, 0.0}, {far, 0.0}, {far, far}, {-far, far}})
            mesh.positions.push_back(base::Vec3f(along * a + away * b));
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        scene.objects.emplace_back();
        scene.objects.back().shape = mesh;
    }
};

scene::Light overhead(bool spot) {
    scene::Light light;
    light.up = Vec3d(0, 0, 1);
    if (spot) {
        light.type = scene::LightType::spot;
        light.position = {0, 4, 0};
        light.target = {0, 0, 0};
        light.angle = 60.0;
    } else {
        light.type = scene::LightType::directional;
        light.direction = {0, -1, 0};
        light.extent = base::Vec2d(2, 2);
    }
    return light;
}

// The lit part of a square of this side whose centre is `distance` on the lit side of a straight edge, where the edge's
// normal has the components (a, b) along the sides: the area of a square below a line, by integrating over one side.
double lit_part(double distance, double side, double a, double b) {
    a = std::abs(a), b = std::abs(b);
    if (a < b) std::swap(a, b);
    double sum = 0.0;
    constexpr int steps = 20000;  // midpoint rule of a piecewise quadratic: error below 1e-8
    for (int i = 0; i < steps; ++i) {
        const double v = side * ((i + 0.5) / steps - 0.5);
        sum += std::clamp((distance + b * v) / (a * side) + 0.5, 0.0, 1.0);
    }
    return sum / steps;
}

TEST(Footprint, AnswersTheClosedFormOfAnEdgeAtEveryResolution) {
    for (const bool spot : {false, true})
        for (const double angle : {0.0, 0.3, 0.7853981633974483}) {
            const HalfPlane plane(angle);
            scene::Receivers receivers;
            receivers.filter_width = {WidthUnit::length, 0.25};
            std::vector<double> expected;
            // The light's rays through a receiver at y = -2 cross the plane y = 0 nearer to the axis by this factor.
            const double nearer = spot ? 4.0 / 6.0 : 1.0;
            for (int i = 0; i < 15; ++i) {
                const double distance = 0.03 * (i - 7);  // of the receiver from the shadow's edge
                receivers.points.push_back(
                    {distance * plane.nx + 0.1 * plane.nz, -2.0, distance * plane.nz - 0.1 * plane.nx});
                expected.push_back(lit_part(distance * nearer, 0.25 * nearer, plane.nx, plane.nz));
            }
            for (const int resolution : {12, 48, 101}) {
                const rays::LightView view =
                    rays::make_light_view(overhead(spot), plane.scene, {resolution, resolution}, "/lights/0");
                const QuerySet set = point_queries(receivers, view);
                ASSERT_EQ(set.queries.size(), expected.size());
                scene::RaySettings settings;
                settings.resolution = {resolution, resolution};
                settings.samples_per_pixel = 400;
                const Truth truth = reference_visibility(plane.scene, view, settings, set.queries, {});
                // Sample cells along a side of the footprint; a cell that the edge or the border cuts may count whole
                // or not at all.
                const double cells = set.queries[0].width * 20;
                for (std::size_t i = 0; i < expected.size(); ++i)
                    EXPECT_NEAR(truth.value[i], expected[i], 3.0 / cells)
                        << "spot " << spot << ", angle " << angle << ", resolution " << resolution << ", point " << i;
            }
        }
}

// A unit as a width in map pixels, for a receiver on the floor below the middle of the light.
float width(WidthUnit unit, double value, bool spot, base::Vec2i resolution, const CameraPoint& point) {
    const HalfPlane plane(0.0);
    const rays::LightView view = rays::make_light_view(overhead(spot), plane.scene, resolution, "/lights/0");
    scene::Receivers receivers;
    receivers.filter_width = {unit, value};
    receivers.bias = 0.1;
    return query_of_point(point, receivers, view).value().width;
}

TEST(Footprint, IsConvertedToMapPixels) {
    const CameraPoint middle{{0, -2, 0}, {0.02, 0, 0}, {0.01, 0, 0.08}};
    EXPECT_EQ(width(WidthUnit::map_pixels, 3.0, true, {64, 64}, middle), 3.0f);
    EXPECT_FLOAT_EQ(width(WidthUnit::share, 0.125, true, {64, 64}, middle), 8.0f);
    EXPECT_FLOAT_EQ(width(WidthUnit::share, 0.125, false, {256, 64}, middle), 32.0f) << "of the map's width";
    EXPECT_FLOAT_EQ(width(WidthUnit::length, 0.5, false, {64, 64}, middle), 16.0f) << "64 pixels are 2 units";
    const double across = 2.0 * 6.0 * std::tan(3.14159265358979 / 6.0);  // of the map, 6 units from the light
    EXPECT_FLOAT_EQ(width(WidthUnit::length, 0.5, true, {64, 64}, middle), static_cast<float>(0.5 * 64 / across))
        << "the bias does not change it";
    EXPECT_FLOAT_EQ(width(WidthUnit::receiver_pixels, 1.0, false, {64, 64}, middle), std::sqrt(0.02f * 0.08f) * 32);
    EXPECT_FLOAT_EQ(width(WidthUnit::receiver_pixels, 2.5, false, {64, 64}, middle),
                    2.5f * std::sqrt(0.02f * 0.08f) * 32);
}

TEST(Footprint, OfAPixelSeenEdgeOnCoversTheMap) {
    constexpr double unbounded = std::numeric_limits<double>::infinity();
    EXPECT_EQ(width(WidthUnit::receiver_pixels, 1.0, false, {64, 64}, {{0, -2, 0}, {unbounded, 0, 0}, {0, 0, 1}}),
              std::numeric_limits<float>::infinity());
}

}  // namespace
}  // namespace shadowbench::bench
