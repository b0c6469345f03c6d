#include "scene/procedural.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "scene/turn.h"

namespace shadowbench::scene {
namespace {

TEST(Turn, AgreesWithTheCLibrary) {
    constexpr double whole = 6.28318530717958647692;
    for (double turns = -2.0; turns <= 2.0; turns += 1.0 / 97.0) {
        const Turn at = turn(turns);
        EXPECT_NEAR(at.cosine, std::cos(whole * turns), 1e-14) << turns;
        EXPECT_NEAR(at.sine, std::sin(whole * turns), 1e-14) << turns;
    }
}

TEST(Across, GivesAnOrthonormalFrame) {
    for (const Vec3d& axis :
         {Vec3d(0, 0, 1), Vec3d(0, 0, -1), Vec3d(1, 0, 0), Vec3d(0.6, 0, -0.8), Vec3d(0, 0.6, 0.8)}) {
        const Across frame = across(axis);
        EXPECT_NEAR(frame.u.length(), 1.0, 1e-12);
        EXPECT_NEAR(frame.v.length(), 1.0, 1e-12);
        EXPECT_NEAR(frame.u.dot(frame.v), 0.0, 1e-12);
        EXPECT_NEAR(frame.u.dot(axis), 0.0, 1e-12);
        EXPECT_NEAR(frame.v.dot(axis), 0.0, 1e-12);
    }
}

HairBall small_ball() {
    HairBall ball;
    ball.strands = 3000;
    ball.centre = Vec3d(1, 2, 3);
    return ball;
}

TEST(HairBall, HasTheStrandsAskedFor) {
    const HairBall ball = small_ball();
    const Hair hair = make_hair_ball(ball);
    ASSERT_EQ(hair.strand_begin.size(), 3001u);
    EXPECT_EQ(hair.points.size(), 3000u * 17);
    EXPECT_EQ(hair.radii.size(), hair.points.size());
    for (std::size_t i = 0; i <= 3000; ++i) ASSERT_EQ(hair.strand_begin[i], i * 17);
}

TEST(HairBall, RootsStandOnTheBallAndTipsAwayFromIt) {
    const HairBall ball = small_ball();
    const Hair hair = make_hair_ball(ball);
    for (std::size_t i = 0; i < 3000; ++i) {
        ASSERT_NEAR((Vec3d(hair.points[i * 17]) - ball.centre).length(), 1.0, 1e-5);
        ASSERT_NEAR((Vec3d(hair.points[i * 17 + 16]) - ball.centre).length(), 1.6, 0.6 * 0.15 + 0.04 * 1.3 + 0.01);
        ASSERT_FLOAT_EQ(hair.radii[i * 17], 0.0015f);
        ASSERT_FLOAT_EQ(hair.radii[i * 17 + 16], 0.0015f * 0.25f);
    }
}

TEST(HairBall, CoversTheBallEvenly) {
    const HairBall ball = small_ball();
    const Hair hair = make_hair_ball(ball);
    // Roots in each of the eight octants: 375 expected; tufts make counts uneven by a tuft's size or so.
    std::array<int, 8> counts{};
    for (std::size_t i = 0; i < 3000; ++i) {
        const Vec3d root = Vec3d(hair.points[i * 17]) - ball.centre;
        ++counts[static_cast<std::size_t>((root.x > 0) + 2 * (root.y > 0) + 4 * (root.z > 0))];
    }
    for (const int count : counts) EXPECT_NEAR(count, 375, 120);
}

TEST(HairBall, HairsAreCurlyAndLeanTogetherWhenClumped) {
    HairBall ball = small_ball();
    ball.clumping = 0.0;
    ball.curl_radius = 0.0;
    // Without curls and tufts a hair is straight: its middle point lies on the line from root to tip.
    const auto bend = [](const Hair& hair, std::size_t strand) {
        const Vec3d root(hair.points[strand * 17]), middle(hair.points[strand * 17 + 8]),
            tip(hair.points[strand * 17 + 16]);
        return (middle - root).cross((tip - root).normalized()).length();
    };
    for (std::size_t i = 0; i < 100; ++i) ASSERT_LT(bend(make_hair_ball(ball), i), 1e-5);
    ball.curl_radius = 0.04;
    const Hair curly = make_hair_ball(ball);
    double sum = 0.0;
    for (std::size_t i = 0; i < 100; ++i) sum += bend(curly, i);
    EXPECT_GT(sum / 100.0, 0.01);

    // Strands 0 and 50 share a tuft (3000 hairs, 50 tufts): clumping brings their tips nearer than their roots.
    ball.curl_radius = 0.0;
    ball.clumping = 1.0;
    const Hair clumped = make_hair_ball(ball);
    double roots = 0.0, tips = 0.0;
    for (std::size_t tuft = 0; tuft < 50; ++tuft) {
        roots += (clumped.points[tuft * 17] - clumped.points[(tuft + 50) * 17]).length();
        tips += (clumped.points[tuft * 17 + 16] - clumped.points[(tuft + 50) * 17 + 16]).length();
    }
    EXPECT_LT(tips, 0.6 * roots);
}

TEST(Cloud, FillsTheEllipsoidAsFarAsCoverageSays) {
    for (const double coverage : {0.2, 0.5, 0.8}) {
        Cloud cloud;
        cloud.size = {40, 30, 20};
        cloud.lower = Vec3d(-2, -1.5, -1);
        cloud.upper = Vec3d(2, 1.5, 1);
        cloud.coverage = coverage;
        const GridVolume volume = make_cloud(cloud);
        EXPECT_EQ(volume.size, cloud.size);
        EXPECT_EQ(volume.upper, cloud.upper);
        double inside = 0.0, filled = 0.0;
        for (int z = 0; z < 20; ++z)
            for (int y = 0; y < 30; ++y)
                for (int x = 0; x < 40; ++x) {
                    const float density = volume.density[static_cast<std::size_t>((z * 30 + y) * 40 + x)];
                    ASSERT_GE(density, 0.0f);
                    ASSERT_LE(density, 1.0f);
                    const Vec3d at((x + 0.5) / 20 - 1, (y + 0.5) / 15 - 1, (z + 0.5) / 10 - 1);
                    if (at.length2() > 1.0) {
                        ASSERT_EQ(density, 0.0f);
                        continue;
                    }
                    inside += 1.0;
                    filled += density > 0.0f;
                }
        EXPECT_NEAR(filled / inside, coverage, 0.01);
        EXPECT_FLOAT_EQ(*std::max_element(volume.density.begin(), volume.density.end()), 1.0f);
    }
}

TEST(Cloud, OctavesAddDetail) {
    Cloud cloud;
    cloud.size = {64, 64, 64};
    const auto roughness = [](const GridVolume& volume) {
        double sum = 0.0;
        for (std::size_t i = 1; i < volume.density.size(); ++i)
            sum += std::abs(volume.density[i] - volume.density[i - 1]);
        return sum;
    };
    cloud.octaves = 1;
    const double smooth = roughness(make_cloud(cloud));
    cloud.octaves = 5;
    EXPECT_GT(roughness(make_cloud(cloud)), 1.2 * smooth);
}

TEST(Cloud, OfOneVoxelStaysInRange) {
    Cloud cloud;
    cloud.size = {1, 1, 1};
    const GridVolume volume = make_cloud(cloud);
    ASSERT_EQ(volume.density.size(), 1u);
    EXPECT_GE(volume.density[0], 0.0f);
    EXPECT_LE(volume.density[0], 1.0f);
}

// Density at voxel (x, y, z).
float voxel(const GridVolume& volume, int x, int y, int z) {
    return volume.density[static_cast<std::size_t>((z * volume.size.y + y) * volume.size.x + x)];
}

// Whether mirroring along each axis leaves the values as they are.
void expect_mirrored(const GridVolume& volume) {
    const base::Vec3i last = volume.size - base::Vec3i(1);
    for (int z = 0; z <= last.z; ++z)
        for (int y = 0; y <= last.y; ++y)
            for (int x = 0; x <= last.x; ++x) {
                const float value = voxel(volume, x, y, z);
                ASSERT_FLOAT_EQ(voxel(volume, last.x - x, y, z), value);
                ASSERT_FLOAT_EQ(voxel(volume, x, last.y - y, z), value);
                ASSERT_FLOAT_EQ(voxel(volume, x, y, last.z - z), value);
            }
}

TEST(DensityBox, FallsEvenlyFromItsMiddleToEveryFace) {
    DensityBox box;
    box.size = {40, 20, 10};
    box.lower = Vec3d(-2, 0, 1);
    box.upper = Vec3d(2, 2, 2);
    const GridVolume volume = make_density_box(box);
    EXPECT_EQ(volume.size, box.size);
    EXPECT_EQ(volume.lower, box.lower);
    EXPECT_EQ(volume.upper, box.upper);
    EXPECT_EQ(volume.step, 0.05);
    expect_mirrored(volume);
    for (int z = 0; z < 10; ++z)
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 40; ++x) {
                // From the nearest face, in halves of the box.
                const double left = std::min(x + 0.5, 39.5 - x) / 20, down = std::min(y + 0.5, 19.5 - y) / 10;
                const double near = std::min(z + 0.5, 9.5 - z) / 5;
                ASSERT_NEAR(voxel(volume, x, y, z), std::min({left, down, near}), 1e-6);
            }
}

TEST(DensityBox, IsDensestInTheMiddleOfThePapersSize) {
    const GridVolume volume = make_density_box({});
    ASSERT_EQ(volume.size, base::Vec3i(64));
    const auto [least, most] = std::minmax_element(volume.density.begin(), volume.density.end());
    EXPECT_FLOAT_EQ(*least, 1.0f / 64.0f);
    EXPECT_FLOAT_EQ(*most, 63.0f / 64.0f);
    EXPECT_EQ(voxel(volume, 31, 32, 31), *most);
}

TEST(CrossedRods, AreSolidInsideThreeCylindersAndEmptyOutside) {
    CrossedRods rods;
    rods.size = {40, 20, 32};
    rods.lower = Vec3d(-2, 0, 1);
    rods.upper = Vec3d(2, 2, 2);
    rods.radius = 0.3;
    const GridVolume volume = make_crossed_rods(rods);
    EXPECT_EQ(volume.size, rods.size);
    EXPECT_EQ(volume.lower, rods.lower);
    EXPECT_EQ(volume.upper, rods.upper);
    EXPECT_EQ(volume.step, 0.5 / 32);
    expect_mirrored(volume);
    for (int z = 0; z < 32; ++z)
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 40; ++x) {
                // World distances from the three axes.
                const double dx = (x + 0.5) * 0.1 - 2.0, dy = (y + 0.5) * 0.1 - 1.0, dz = (z + 0.5) / 32 - 0.5;
                const double distance = std::min({std::hypot(dy, dz), std::hypot(dz, dx), std::hypot(dx, dy)});
                if (std::abs(distance - 0.3) < 1e-9) continue;
                ASSERT_EQ(voxel(volume, x, y, z), distance < 0.3 ? 1.0f : 0.0f) << x << " " << y << " " << z;
            }
}

TEST(CrossedRods, FillTheShareOfTheBoxThatCylindersFill) {
    CrossedRods rods;
    EXPECT_EQ(rods.size, base::Vec3i(64));
    rods.size = base::Vec3i(128);
    rods.radius = 0.4;
    double filled = 0.0;
    for (const float value : make_crossed_rods(rods).density) filled += value;
    // Three cylinders of length 2, less what two and three of them share (Steinmetz: 16/3 r^3 and (16 - 8 sqrt 2) r^3).
    const double r = rods.radius, pi = 3.14159265358979;
    const double solid = 3 * 2 * pi * r * r + (-3 * 16.0 / 3.0 + 16.0 - 8.0 * std::sqrt(2.0)) * r * r * r;
    EXPECT_NEAR(filled / (128.0 * 128.0 * 128.0), solid / 8.0, 0.01 * solid / 8.0);
}

TEST(SmokeColumn, WidensAndThinsOutUpwards) {
    SmokeColumn column;
    column.base = Vec3d(5, 1, 0);
    const Particles smoke = make_smoke_column(column);
    ASSERT_EQ(smoke.centres.size(), 2000u);
    double lowest = 1e9, highest = -1e9;
    for (std::size_t i = 0; i < 2000; ++i) {
        const Vec3d at = Vec3d(smoke.centres[i]) - column.base;
        const double rise = at.y / column.height;
        lowest = std::min(lowest, rise);
        highest = std::max(highest, rise);
        ASSERT_GE(rise, 0.0);
        ASSERT_LE(rise, 1.0 + 1e-6);
        ASSERT_LE(std::hypot(at.x, at.z), 0.5 * 0.35 * (1.0 + 2.0 * rise) + 1e-6);
        ASSERT_NEAR(smoke.radii[i] / (0.12 * (1.0 + rise)), 1.0, 0.2 + 1e-5);
        ASSERT_NEAR(smoke.density[i], 2.0 * (1.0 - 0.75 * rise), 1e-5);
    }
    EXPECT_LT(lowest, 0.01);
    EXPECT_GT(highest, 0.99);
}

TEST(Procedural, IsTheSameOnAnyNumberOfThreadsAndOtherForAnotherSeed) {
    HairBall ball = small_ball();
    Cloud cloud;
    cloud.size = {20, 20, 20};
    SmokeColumn column;
    const Hair hair = make_hair_ball(ball);
    const GridVolume volume = make_cloud(cloud);
    const Particles smoke = make_smoke_column(column);
    {
        const base::ThreadLimit one(1);
        EXPECT_EQ(make_hair_ball(ball).points, hair.points);
        EXPECT_EQ(make_cloud(cloud).density, volume.density);
    }
    ball.seed = cloud.seed = column.seed = 2;
    EXPECT_NE(make_hair_ball(ball).points, hair.points);
    EXPECT_NE(make_cloud(cloud).density, volume.density);
    EXPECT_NE(make_smoke_column(column).centres, smoke.centres);
}

}  // namespace
}  // namespace shadowbench::scene
