// Rays marched side by side, against each of them by itself.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"
#include "base/simd_path.h"
#include "rays/exp_minus.h"
#include "rays/grids.h"
#include "rays/march.h"
#include "rays/medium_floats.h"

namespace shadowbench::rays {
namespace {

using testing::grid;
using testing::Line;
using testing::line_through;
using testing::odd_grids;

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

}  // namespace
}  // namespace shadowbench::rays
