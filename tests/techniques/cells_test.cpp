#include "techniques/store/cells.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace shadowbench::techniques {
namespace {

TEST(Stretch, CoversTheCellsThatAFootprintReachesByTheirParts) {
    for (const double filled : {16.0, 15.25})
        for (const double width : {0.1, 0.5, 1.0, 1.7, 3.0, 20.0, 1e30})
            for (double at = 0.0; at < filled; at += 0.217) {
                const Stretch s = stretch(at, width, filled);
                double sum = 0.0;
                for (int x = 0; x < 16; ++x) {
                    const double low = std::max<double>(x, at - 0.5 * width);
                    const double part = std::min({x + 1.0, at + 0.5 * width, filled}) - low;
                    const bool in = x >= s.begin && x < s.end;
                    ASSERT_EQ(in, part > 0.0) << at << " " << width << " cell " << x;
                    if (in) {
                        ASSERT_NEAR(s.weight(x), part, 1e-12) << at << " " << width << " cell " << x;
                    }
                    sum += in ? s.weight(x) : 0.0;
                }
                ASSERT_NEAR(sum, std::min(at + 0.5 * width, filled) - std::max(at - 0.5 * width, 0.0), 1e-12);
            }
}

TEST(Stretch, ThatCoversNothingIsTheCellOfItsCentre) {
    for (const double at : {0.0, 3.0, 7.99, 12.5}) {
        const Stretch s = stretch(at, 0.0, 13.0);
        EXPECT_EQ(s.begin, static_cast<int>(at));
        EXPECT_EQ(s.end, s.begin + 1);
        EXPECT_EQ(s.weight(s.begin), 1.0);
    }
}

}  // namespace
}  // namespace shadowbench::techniques
