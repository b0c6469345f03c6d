#include "rays/march.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/simd_path.h"
#include "rays/exp_minus.h"
#include "rays/medium_floats.h"
#include "scene/scene.h"

namespace shadowbench::rays {
namespace {

scene::GridVolume grid(base::Vec3i size, double step) {
    scene::GridVolume g;
    g.size = size;
    g.density.assign(static_cast<std::size_t>(size.x) * size.y * size.z, 0.0f);
    g.lower = {-1, -2, -3};
    g.upper = {2, 2, 3};
    g.step = step;
    return g;
}

float& at(scene::GridVolume& g, int x, int y, int z) {
    return g.density[(static_cast<std::size_t>(z) * g.size.y + y) * g.size.x + x];
}

double depth_of(const std::vector<MediumSegment>& segments) {
    double sum = 0.0;
    for (const MediumSegment& s : segments) sum += s.depth;
    return sum;
}

// The same integral by many small steps over a plain trilinear lookup.
double brute_force(scene::GridVolume& g, base::Vec3d origin, base::Vec3d direction) {
    double sum = 0.0;
    constexpr double dt = 1e-4;
    for (double t = 0.5 * dt; t < 20; t += dt) {
        const base::Vec3d p = origin + direction * t;
        base::Vec3d i;
        bool inside = true;
        for (int a = 0; a < 3; ++a) {
            inside &= p[a] >= g.lower[a] && p[a] <= g.upper[a];
            i[a] = std::clamp((p[a] - g.lower[a]) / (g.upper[a] - g.lower[a]) * g.size[a] - 0.5, 0.0, g.size[a] - 1.0);
        }
        if (!inside) continue;
        const int x = std::min(static_cast<int>(i.x), g.size.x - 2), y = std::min(static_cast<int>(i.y), g.size.y - 2),
                  z = std::min(static_cast<int>(i.z), g.size.z - 2);
        double value = 0.0;
        for (int c = 0; c < 8; ++c) {
            const int dx = c & 1, dy = c >> 1 & 1, dz = c >> 2;
            value += at(g, x + dx, y + dy, z + dz) * (dx ? i.x - x : 1 - i.x + x) * (dy ? i.y - y : 1 - i.y + y) *
                     (dz ? i.z - z : 1 - i.z + z);
        }
        sum += value * dt;
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

// Trilinear, without blocks.
double plain_density(const scene::GridVolume& g, const base::Vec3d& point) {
    double value = 0.0, place[3];
    for (int a = 0; a < 3; ++a)
        place[a] =
            std::clamp((point[a] - g.lower[a]) / (g.upper[a] - g.lower[a]) * g.size[a] - 0.5, 0.0, g.size[a] - 1.0);
    for (int c = 0; c < 8; ++c) {
        double weight = 1.0;
        int at[3];
        for (int a = 0; a < 3; ++a) {
            const int low = static_cast<int>(place[a]);
            weight *= c >> a & 1 ? place[a] - low : 1 - place[a] + low;
            at[a] = std::min(low + (c >> a & 1), g.size[a] - 1);
        }
        value += weight * g.density[(static_cast<std::size_t>(at[2]) * g.size.y + at[1]) * g.size.x + at[0]];
    }
    return value;
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

// Grids for the two exact functions: with holes, empty blocks, and single voxels along an axis.
std::vector<scene::GridVolume> odd_grids() {
    base::Random random(8);
    std::vector<scene::GridVolume> grids;
    for (const base::Vec3i& size : {base::Vec3i(5, 4, 3), base::Vec3i(1, 1, 4), base::Vec3i(2, 1, 1),
                                    base::Vec3i(1, 1, 1), base::Vec3i(40, 37, 51)}) {
        grids.push_back(grid(size, 0.4));
        for (float& d : grids.back().density)
            d = static_cast<float>(std::max(0.0, random.uniform(size.x > 8 ? -40.0 : -0.5, 1.5)));
    }
    return grids;
}

// A ray through the box, sometimes along an axis or a diagonal of voxels.
struct Line {
    base::Vec3d origin, direction;
};
Line line_through(const scene::GridVolume& g, base::Random& random) {
    base::Vec3d target, d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    for (int a = 0; a < 3; ++a) target[a] = random.uniform(g.lower[a], g.upper[a]);
    switch (random.below(5)) {
        case 0:
            d[static_cast<int>(random.below(3))] = 0.0;
            break;
        case 1:
            d = base::Vec3d(0, 0, 0);
            d[static_cast<int>(random.below(3))] = random.below(2) ? 1.0 : -1.0;
            break;
        case 2:  // through corners of cells
            for (int a = 0; a < 3; ++a) {
                const double voxel = (g.upper[a] - g.lower[a]) / g.size[a];
                target[a] = g.lower[a] + (std::floor((target[a] - g.lower[a]) / voxel) + 0.5) * voxel;
                d[a] = voxel * (random.below(2) ? 1 : -1);
            }
            break;
        default:
            break;
    }
    d.normalize();
    return {target - d * 9.0, d};
}

// The integral of a plain trilinear lookup up to t, in 100,000 steps.
double by_steps(const scene::GridVolume& g, const Line& line, double t) {
    double first = 0.0, last = t, sum = 0.0;
    for (int a = 0; a < 3; ++a) {
        if (line.direction[a] == 0.0) continue;
        const double t0 = (g.lower[a] - line.origin[a]) / line.direction[a],
                     t1 = (g.upper[a] - line.origin[a]) / line.direction[a];
        first = std::max(first, std::min(t0, t1));
        last = std::min(last, std::max(t0, t1));
    }
    constexpr int steps = 100000;
    for (int k = 0; k < steps && first < last; ++k) {
        const base::Vec3d p = line.origin + line.direction * (first + (last - first) * (k + 0.5) / steps);
        double value = 0.0;
        base::Vec3d i;
        for (int a = 0; a < 3; ++a)
            i[a] = std::clamp((p[a] - g.lower[a]) / (g.upper[a] - g.lower[a]) * g.size[a] - 0.5, 0.0, g.size[a] - 1.0);
        for (int c = 0; c < 8; ++c) {
            double weight = 1.0;
            int at[3];
            for (int a = 0; a < 3; ++a) {
                const int low = static_cast<int>(i[a]);
                weight *= c >> a & 1 ? i[a] - low : 1 - i[a] + low;
                at[a] = std::min(low + (c >> a & 1), g.size[a] - 1);
            }
            value += weight * g.density[(static_cast<std::size_t>(at[2]) * g.size.y + at[1]) * g.size.x + at[0]];
        }
        sum += value * (last - first) / steps;
    }
    return sum;
}

TEST(March, OpticalDepthsAreExactAtEveryDepthInsideCellsToo) {
    base::Random random(21);
    for (const scene::GridVolume& g : odd_grids()) {
        const VolumeMarcher marcher(g);
        int met = 0;
        for (int i = 0; i < 25; ++i) {
            const Line line = line_through(g, random);
            std::vector<double> t(6), depth(6);
            for (double& place : t) place = random.uniform(2, 16);
            std::sort(t.begin(), t.end());
            marcher.optical_depths(line.origin, line.direction, 1.5, 0.0, t, depth);
            for (std::size_t k = 0; k < t.size(); ++k) {
                EXPECT_NEAR(depth[k], 1.5 * by_steps(g, line, t[k]), 1e-7) << g.size.x << " voxels, ray " << i;
                met += depth[k] > 0.0;
            }
        }
        EXPECT_GT(met, 30);
    }
}

TEST(March, CellsHoldExactlyWhatLiesBetweenTheirWalls) {
    base::Random random(22);
    for (const scene::GridVolume& g : odd_grids()) {
        const VolumeMarcher marcher(g);
        std::size_t found = 0;
        for (int i = 0; i < 100; ++i) {
            const Line line = line_through(g, random);
            std::vector<MediumSegment> cells;
            const double end = i % 2 ? 1e30 : random.uniform(5, 12);
            marcher.march_cells(line.origin, line.direction, 1.0, 0, end, cells);
            found += cells.size();
            double sum = 0.0;
            for (std::size_t s = 0; s < cells.size(); ++s) {
                EXPECT_LT(cells[s].front, cells[s].back);
                if (s) {
                    EXPECT_GE(cells[s].front, cells[s - 1].back);
                }
                sum += cells[s].depth;
                double exact = 0.0;
                const double back = cells[s].back;
                marcher.optical_depths(line.origin, line.direction, 1.0, 0, {&back, 1}, {&exact, 1});
                if (back < end) {
                    EXPECT_NEAR(sum, exact, 1e-5) << "up to the rounding of the wall to a float";
                }
            }
            double all = 0.0;
            marcher.optical_depths(line.origin, line.direction, 1.0, 0, {&end, 1}, {&all, 1});
            EXPECT_NEAR(sum, all, 1e-12);
            EXPECT_LE(cells.size(), static_cast<std::size_t>(g.size.x + g.size.y + g.size.z + 3));
        }
        EXPECT_GT(found, 50u);
    }
}

TEST(March, CellsShorterThanAFloatLoseNothing) {
    scene::GridVolume g = grid({4, 4, 600}, 1.0);
    for (float& d : g.density) d = 1;
    std::vector<MediumSegment> segments;
    VolumeMarcher(g).march_cells({0, 0, -1e6}, {0, 0, 1}, 1.0, 0, 1e30, segments);
    EXPECT_NEAR(depth_of(segments), 6.0, 1e-6);
    for (const MediumSegment& s : segments) EXPECT_LT(s.front, s.back);
    EXPECT_LE(segments.size(), 97u) << "6 units of 16 floats, and one float more";
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

// Neighbours end, miss and cross empty space at different steps: what one ray meets may not reach another.
TEST(March, SideBySideIsOneByOneToTheBitWithAllInstructions) {
    base::Random random(31);
    std::size_t found = 0;
    for (const scene::GridVolume& g : odd_grids()) {
        const VolumeMarcher marcher(g);
        for (int i = 0; i < 20; ++i) {
            const Line line = line_through(g, random);
            std::vector<WorldRay> rays(1 + random.below(side_by_side));
            for (WorldRay& ray : rays) {
                const double spread = i % 2 ? 0.05 : 2.0;
                const base::Vec3d aside(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
                ray = {line.origin + aside * spread, line.direction, 1.0 + random.uniform()};
            }
            const float extinction = i % 3 ? 1.5f : 1e-7f;
            for (const base::SimdPath path : base::simd_paths()) {
                base::set_simd_path(path);
                Lanes<std::vector<MediumStep>> steps;
                ASSERT_EQ(marcher.march_side_by_side(rays, 0.0, 1e30, extinction, steps), g.size.x > 1);
                for (std::size_t r = 0; r < rays.size() && g.size.x > 1; ++r) {
                    std::vector<MediumSegment> segments;
                    marcher.march(rays[r].origin, rays[r].direction, rays[r].scale, 0.0, 1e30, segments);
                    StepRounding rounding;
                    std::size_t s = 0;
                    for (const MediumSegment& segment : segments) {
                        const float t = rounding.transmittance(0, segment.depth * static_cast<double>(extinction));
                        if (t == 1.0f) continue;
                        ASSERT_LT(s, steps[r].size());
                        EXPECT_EQ(steps[r][s].front, segment.front);
                        EXPECT_EQ(steps[r][s].back, segment.back);
                        EXPECT_EQ(steps[r][s++].transmittance, t);
                    }
                    EXPECT_EQ(s, steps[r].size());
                    found += s;
                }
            }
            base::set_simd_path(base::simd_paths().back());
        }
    }
    EXPECT_GT(found, 1000u);
}

TEST(March, SideBySideLeavesShortAndDarkStepsToTheOtherWay) {
    scene::GridVolume g = grid({4, 4, 4}, 0.25);
    for (float& d : g.density) d = 1;
    Lanes<std::vector<MediumStep>> steps;
    const auto march = [&](double distance, float extinction) {
        const WorldRay ray{{0, 0, -distance}, {0, 0, 1}, 1.0};
        return VolumeMarcher(g).march_side_by_side({&ray, 1}, 0.0, 1e30, extinction, steps);
    };
    EXPECT_TRUE(march(10, 1.0f));
    EXPECT_EQ(steps[0].size(), 24u);
    EXPECT_FALSE(march(4e6, 1.0f)) << "a quarter is less than a float there";
    EXPECT_FALSE(march(10, 400.0f)) << "a step of depth 100 has no float transmittance";
}

TEST(ExpMinus, IsTheExponentialToTheLastPlace) {
    base::Random random(6);
    for (int i = 0; i < 100'000; ++i) {
        const double x = i % 2 ? random.uniform(-1.0, most_depth) : std::pow(10.0, random.uniform(-20.0, 0.0));
        const long double exact = std::exp(-static_cast<long double>(x));
        ASSERT_NEAR(static_cast<double>(exp_minus(x) / exact), 1.0, 0x1p-52) << x;
    }
    EXPECT_EQ(exp_minus(0.0), 1.0);
}

TEST(SphereStretch, KeepsItsDigitsFarAway) {
    double front, back;
    ASSERT_TRUE(sphere_stretch({0, 0, -1e6}, {0, 0, 1}, {0.001, 0, 0}, 0.002, front, back));
    EXPECT_NEAR(back - front, 2 * std::sqrt(0.002 * 0.002 - 0.001 * 0.001), 1e-9);
    EXPECT_FALSE(sphere_stretch({0, 0, -1e6}, {0, 0, 1}, {0.003, 0, 0}, 0.002, front, back));
}

}  // namespace
}  // namespace shadowbench::rays
