// The exact optical depths of grids, cell by cell.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "rays/grids.h"
#include "rays/march.h"

namespace shadowbench::rays {
namespace {

using testing::depth_of;
using testing::grid;
using testing::Line;
using testing::line_through;
using testing::odd_grids;
using testing::plain_density;

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
        sum += plain_density(g, p) * (last - first) / steps;
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

}  // namespace
}  // namespace shadowbench::rays
