#include "techniques/cells.h"

#include <gtest/gtest.h>

namespace shadowbench::techniques {
namespace {

TEST(Footprint, HoldsTheCellsWhoseCentresLieInIt) {
    const CellGrid grid{16, 16, 2.0f, 2.0f};
    for (const float width : {0.1f, 0.5f, 1.0f, 1.7f, 3.0f, 20.0f})
        for (float px = 0.03f; px < 8; px += 0.217f) {
            const CellRange r = footprint(grid, {px, 4.1f, 0, width});
            int inside = 0;
            for (int x = 0; x < 16; ++x) {
                const bool in = std::abs((static_cast<float>(x) + 0.5f) / 2 - px) <= 0.5f * width;
                inside += in;
                if (in) {
                    EXPECT_TRUE(x >= r.x0 && x < r.x1) << px << " " << width;
                }
            }
            EXPECT_EQ(r.x1 - r.x0, std::max(inside, 1)) << px << " " << width;
        }
}

TEST(Footprint, IsEmptyOutsideTheMap) {
    const CellGrid grid{8, 8, 1.0f, 1.0f};
    for (const float x : {-0.1f, 8.0f, 1e30f, std::numeric_limits<float>::quiet_NaN()}) {
        const CellRange r = footprint(grid, {x, 4, 0, 1});
        EXPECT_TRUE(r.x0 >= r.x1 || r.y0 >= r.y1);
    }
}

}  // namespace
}  // namespace shadowbench::techniques
