// Regular steps through grids of voxels.
#include "rays/march.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "rays/grids.h"

namespace shadowbench::rays {
namespace {

using testing::at;
using testing::depth_of;
using testing::grid;
using testing::plain_density;

// The same integral by many small steps over a plain trilinear lookup.
double brute_force(const scene::GridVolume& g, const base::Vec3d& origin, const base::Vec3d& direction) {
    double sum = 0.0;
    constexpr double dt = 1e-4;
    for (double t = 0.5 * dt; t < 20; t += dt) {
        const base::Vec3d p = origin + direction * t;
        bool inside = true;
        for (int a = 0; a < 3; ++a) inside &= p[a] >= g.lower[a] && p[a] <= g.upper[a];
        if (inside) sum += plain_density(g, p) * dt;
    }
    return sum;
}

TEST(March, SkippingEmptyBlocksLosesNothing) {
    // Few voxels have density, most blocks are empty, and rays run in all directions, also along axes.
    scene::GridVolume g = grid({40, 37, 51}, 0.01);
    base::Random random(1);
    for (int i = 0; i < 25; ++i)
        at(g, static_cast<int>(random.below(40)), static_cast<int>(random.below(37)),
           static_cast<int>(random.below(51))) = static_cast<float>(random.uniform(1, 3));
    for (const auto& [x, y, z] : {std::tuple{0, 0, 0}, {39, 36, 50}, {7, 8, 15}, {8, 7, 16}, {20, 36, 23}})
        at(g, x, y, z) = 2;
    const VolumeMarcher marcher(g);
    int hit = 0;
    for (int i = 0; i < 60; ++i) {
        // Through a voxel that has density.
        std::size_t v = random.below(g.density.size());
        while (g.density[v] == 0.0f) v = (v + 1) % g.density.size();
        const base::Vec3d voxel(static_cast<double>(v % 40), static_cast<double>(v / 40 % 37),
                                static_cast<double>(v / 40 / 37));
        base::Vec3d target;
        for (int a = 0; a < 3; ++a)
            target[a] =
                g.lower[a] + (voxel[a] + 0.5 + random.uniform(-0.4, 0.4)) / g.size[a] * (g.upper[a] - g.lower[a]);
        base::Vec3d d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        if (i % 6 < 3) {
            d = base::Vec3d(0, 0, 0);
            d[i % 3] = i % 2 ? 1 : -1;
        }
        d.normalize();
        const base::Vec3d origin = target - d * 8.0;
        std::vector<MediumSegment> segments;
        marcher.march(origin, d, 1.0, 0, 1e30, segments);
        const double expected = brute_force(g, origin, d);
        EXPECT_NEAR(depth_of(segments), expected, 0.002 * expected + 1e-4);
        hit += !segments.empty();
        for (std::size_t s = 1; s < segments.size(); ++s) EXPECT_GE(segments[s].front, segments[s - 1].back);
    }
    EXPECT_EQ(hit, 60);
}

// Otherwise the step that leads from empty space into density is lost.
TEST(March, IsTheTrapezoidRuleOverAllSteps) {
    base::Random random(4);
    scene::GridVolume g = grid({40, 37, 51}, 0.3);
    for (int i = 0; i < 60; ++i) g.density[random.below(g.density.size())] = static_cast<float>(random.uniform(1, 3));
    const VolumeMarcher marcher(g);
    int met = 0;
    for (int i = 0; i < 300; ++i) {
        base::Vec3d d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        d.normalize();
        std::size_t v = random.below(g.density.size());
        while (g.density[v] == 0.0f) v = (v + 1) % g.density.size();
        const base::Vec3d voxel(static_cast<double>(v % 40) + 0.5, static_cast<double>(v / 40 % 37) + 0.5,
                                static_cast<double>(v / 40 / 37) + 0.5);
        base::Vec3d target;
        for (int a = 0; a < 3; ++a) target[a] = g.lower[a] + voxel[a] / g.size[a] * (g.upper[a] - g.lower[a]);
        const base::Vec3d origin = target - d * 12.0;
        double front = 0.0, back = 1e30, sum = 0.0;
        for (int a = 0; a < 3; ++a) {
            const double t0 = (g.lower[a] - origin[a]) / d[a], t1 = (g.upper[a] - origin[a]) / d[a];
            front = std::max(front, std::min(t0, t1));
            back = std::min(back, std::max(t0, t1));
        }
        for (int k = 0; front + k * 0.3 < back; ++k) {
            const double from = front + k * 0.3, to = std::min(from + 0.3, back);
            sum += 0.5 * (plain_density(g, origin + d * from) + plain_density(g, origin + d * to)) * (to - from);
        }
        std::vector<MediumSegment> segments;
        marcher.march(origin, d, 1.0, 0, 1e30, segments);
        EXPECT_NEAR(depth_of(segments), sum, 1e-9) << "ray " << i;
        met += sum > 0.0;
    }
    EXPECT_GT(met, 200);
}

TEST(March, StepsAreRegularAndShareTheirEnds) {
    scene::GridVolume g = grid({4, 4, 4}, 0.25);
    for (float& d : g.density) d = 1;
    std::vector<MediumSegment> segments;
    VolumeMarcher(g).march({0, 0, -10}, {0, 0, 1}, 1.0, 0, 1e30, segments);
    ASSERT_EQ(segments.size(), 24u) << "6 units in quarters";
    for (std::size_t i = 0; i < segments.size(); ++i) {
        EXPECT_FLOAT_EQ(segments[i].back - segments[i].front, 0.25f);
        EXPECT_DOUBLE_EQ(segments[i].depth, 0.25);
        if (i) {
            EXPECT_EQ(segments[i].front, segments[i - 1].back);
        }
    }
}

TEST(March, ADensityThatGrowsLinearlyIsIntegratedExactlyByTrapezoids) {
    scene::GridVolume g = grid({4, 4, 60}, 0.1);
    for (int z = 0; z < 60; ++z)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) at(g, x, y, z) = static_cast<float>(z);
    std::vector<MediumSegment> segments;
    VolumeMarcher(g).march({0, 0, -10}, {0, 0, 1}, 1.0, 0, 1e30, segments);
    // Voxels are 0.1 long and sampled at their borders, where neighbours meet half-way; the ends are flat.
    EXPECT_NEAR(depth_of(segments), 0.1 * (60 * 59 / 2), 0.01);
}

TEST(March, IsClippedToTheStretchAskedFor) {
    scene::GridVolume g = grid({4, 4, 4}, 0.25);
    for (float& d : g.density) d = 1;
    std::vector<MediumSegment> segments;
    VolumeMarcher(g).march({0, 0, 0}, {0, 0, 1}, 1.0, 0.1, 1.2, segments);
    EXPECT_FLOAT_EQ(segments.front().front, 0.1f);
    EXPECT_FLOAT_EQ(segments.back().back, 1.2f);
    EXPECT_NEAR(depth_of(segments), 1.1, 1e-12);
    segments.clear();
    VolumeMarcher(g).march({5, 0, 0}, {0, 0, 1}, 1.0, 0, 1e30, segments);
    EXPECT_TRUE(segments.empty()) << "beside the box";
}

TEST(March, StepsShorterThanAFloatLoseNothing) {
    // At a depth of 1e6 floats are 1/16 apart: fifteen of sixteen steps have both ends at one float.
    scene::GridVolume g = grid({4, 4, 4}, 0.004);
    for (float& d : g.density) d = 1;
    std::vector<MediumSegment> segments;
    VolumeMarcher(g).march({0, 0, -1e6}, {0, 0, 1}, 1.0, 0, 1e30, segments);
    EXPECT_NEAR(depth_of(segments), 6.0, 1e-6);
    double before = 0.0;
    for (const MediumSegment& s : segments) {
        EXPECT_LT(s.front, s.back);
        EXPECT_NEAR(before, s.front - (1e6 - 3), 0.1) << "each step's depth stays where it was";
        before += s.depth;
    }
    EXPECT_LE(segments.size(), 97u) << "6 units of 16 floats, and one float more";
}

TEST(March, ABoxThinnerThanAFloatIsNotLost) {
    scene::GridVolume g = grid({1, 1, 1}, 1.0);
    g.density[0] = 1000;
    g.lower.z = 1.0;
    g.upper.z = 1.0 + 1e-9;
    std::vector<MediumSegment> segments;
    VolumeMarcher(g).march({0, 0, 0}, {0, 0, 1}, 1.0, 0, 1e30, segments);
    ASSERT_EQ(segments.size(), 1u);
    EXPECT_NEAR(segments[0].depth, 1e-6, 1e-12);
    EXPECT_LT(segments[0].front, segments[0].back);
}

TEST(SphereStretch, KeepsItsDigitsFarAway) {
    double front, back;
    ASSERT_TRUE(sphere_stretch({0, 0, -1e6}, {0, 0, 1}, {0.001, 0, 0}, 0.002, front, back));
    EXPECT_NEAR(back - front, 2 * std::sqrt(0.002 * 0.002 - 0.001 * 0.001), 1e-9);
    EXPECT_FALSE(sphere_stretch({0, 0, -1e6}, {0, 0, 1}, {0.003, 0, 0}, 0.002, front, back));
}

}  // namespace
}  // namespace shadowbench::rays
