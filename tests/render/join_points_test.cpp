#include "render/join_points.h"

#include <gtest/gtest.h>

namespace shadowbench::render {
namespace {

using base::Vec3d;
using base::Vec3f;
using Kind = SeenPoint::Kind;

// 2 x 2 view rays, a pixel 0.1 wide at the distance 10 at which the points lie.
const JoinSettings settings{.lights = 1, .rays_per_side = 2, .pixel = 0.01, .step = 0.5};

SeenPoint at(Kind kind, double x, double z, float coverage) {
    SeenPoint point;
    point.kind = kind;
    point.t = z;
    point.place = Vec3d(x, 0.0, z);
    point.across = Vec3f(0.05f, 0.0f, 0.0f);
    point.down = Vec3f(0.0f, 0.05f, 0.0f);
    if (kind == Kind::surface) point.normal = Vec3f(0.0f, 0.0f, -1.0f);
    point.coverage = Vec3f(coverage);
    return point;
}

PixelPoints pixel_of(const std::vector<SeenPoint>& points) {
    PixelPoints pixel;
    for (const SeenPoint& point : points) {
        pixel.points.push_back(point);
        pixel.radiance.push_back(point.coverage * 0.5f);
    }
    return pixel;
}

std::size_t joined_count(const std::vector<SeenPoint>& points) {
    PixelPoints pixel = pixel_of(points);
    join_points(settings, pixel);
    EXPECT_EQ(pixel.points.size(), pixel.radiance.size());
    return pixel.points.size();
}

// Four lookups a pixel where one does.
TEST(JoinPoints, makes_one_of_the_points_of_a_plane) {
    PixelPoints pixel = pixel_of({at(Kind::surface, 0.0, 10.0, 0.25f), at(Kind::surface, 0.05, 10.0, 0.25f),
                                  at(Kind::surface, 0.0, 10.02, 0.25f), at(Kind::surface, 0.05, 10.02, 0.125f)});
    join_points(settings, pixel);
    ASSERT_EQ(pixel.points.size(), 1u);
    const SeenPoint& point = pixel.points[0];
    EXPECT_FLOAT_EQ(point.coverage.x, 0.875f);
    EXPECT_FLOAT_EQ(pixel.radiance[0].y, 0.4375f);
    EXPECT_NEAR(point.place.x, 0.05 * 0.375 / 0.875, 1e-12) << "the mean by coverage";
    EXPECT_NEAR(point.place.z, 10.0 + 0.02 * 0.375 / 0.875, 1e-12);
    EXPECT_FLOAT_EQ(point.across.x, 0.1f) << "the edge of the pixel";
    EXPECT_FLOAT_EQ(point.down.y, 0.1f);
}

// An edge of a thing and the ground far behind it would share a shadow.
TEST(JoinPoints, leaves_apart_what_is_not_one_place) {
    const SeenPoint front = at(Kind::surface, 0.0, 10.0, 0.25f);
    EXPECT_EQ(joined_count({front, at(Kind::surface, 0.05, 13.0, 0.25f)}), 2u) << "behind it";
    EXPECT_EQ(joined_count({front, at(Kind::surface, 0.05, 10.15, 0.25f)}), 2u) << "a step of more than a pixel";
    SeenPoint side = at(Kind::surface, 0.05, 10.0, 0.25f);
    side.normal = Vec3f(1.0f, 0.0f, 0.0f);
    EXPECT_EQ(joined_count({front, side}), 2u) << "another side of a box";
    EXPECT_EQ(joined_count({front, at(Kind::hair, 0.05, 10.0, 0.25f)}), 2u) << "hair on skin";
    EXPECT_EQ(joined_count({at(Kind::hair, 0.0, 10.0, 0.2f), at(Kind::hair, 0.05, 10.08, 0.2f)}), 1u);
    EXPECT_EQ(joined_count({at(Kind::hair, 0.0, 10.0, 0.2f), at(Kind::hair, 0.05, 10.12, 0.2f)}), 2u);
    PixelPoints seam = pixel_of({front, at(Kind::surface, 0.05, 10.0, 0.25f)});
    seam.radiance[1] = Vec3f(0.0f);
    join_points(settings, seam);
    EXPECT_EQ(seam.points.size(), 2u) << "a seam of two faces of a light";
}

// The steps of four rays through a medium; each ray begins a little later.
TEST(JoinPoints, keeps_the_steps_of_a_medium_apart) {
    std::vector<SeenPoint> points;
    for (int ray = 0; ray < 4; ++ray)
        for (int step = 0; step < 20; ++step)
            points.push_back(at(Kind::medium, 0.02 * ray, 10.0 + 0.05 * ray + 0.5 * step, 0.01f));
    PixelPoints pixel = pixel_of(points);
    join_points(settings, pixel);
    ASSERT_EQ(pixel.points.size(), 20u);
    for (std::size_t step = 0; step < 20; ++step) {
        EXPECT_NEAR(pixel.points[step].place.z, 10.075 + 0.5 * static_cast<double>(step), 1e-6);
        EXPECT_NEAR(pixel.points[step].coverage.x, 0.04f, 1e-6);
    }
}

TEST(JoinPoints, finds_a_place_for_what_covers_nothing) {
    PixelPoints pixel = pixel_of({at(Kind::medium, 1.0, 10.0, 0.0f), at(Kind::medium, 2.0, 10.0, 0.0f)});
    join_points(settings, pixel);
    ASSERT_EQ(pixel.points.size(), 1u);
    EXPECT_EQ(pixel.points[0].place, Vec3d(1.0, 0.0, 10.0));
}

}  // namespace
}  // namespace shadowbench::render
