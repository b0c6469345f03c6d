#include "claims/polygon_area.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shadowbench::claims {
namespace {

TEST(PolygonArea, IsThatOfTheCommonPart) {
    const Polygon square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    EXPECT_DOUBLE_EQ(area_inside(square, 0, 0), 1.0);
    EXPECT_DOUBLE_EQ(area_inside(square, 0.5, 0.25), 0.5 * 0.75);
    EXPECT_DOUBLE_EQ(area_inside(square, 1, 0), 0.0) << "a common edge";
    EXPECT_DOUBLE_EQ(area_inside(square, 5, 5), 0.0);
    const Polygon clockwise{{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    EXPECT_DOUBLE_EQ(area_inside(clockwise, 0.5, 0.5), 0.25);
    const Polygon diamond{{0.5, -0.5}, {1.5, 0.5}, {0.5, 1.5}, {-0.5, 0.5}};  // its corners stick out on every side
    EXPECT_DOUBLE_EQ(area_inside(diamond, 0, 0), 1.0);
    EXPECT_DOUBLE_EQ(area_inside(diamond, 1, 0), 0.25);
    const Polygon triangle{{0, 0}, {1, 0}, {0, 1}};
    EXPECT_DOUBLE_EQ(area_inside(triangle, 0, 0), 0.5);
    EXPECT_DOUBLE_EQ(area_inside(triangle, 0.5, 0), 0.125);
    EXPECT_DOUBLE_EQ(area_inside({{2, 2}, {2, 2}, {2, 2}, {2, 2}}, 2, 2), 0.0) << "no area at all";
}

TEST(PolygonArea, OfAllPixelsTogetherIsThatOfThePolygon) {
    const Polygon turned{{10.3, 4.1}, {17.9, 9.6}, {15.2, 13.4}, {7.6, 7.9}};
    double twice = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
        twice += turned[i][0] * turned[(i + 1) % 4][1] - turned[(i + 1) % 4][0] * turned[i][1];
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x) sum += area_inside(turned, x, y);
    EXPECT_NEAR(sum, 0.5 * std::abs(twice), 1e-12);
}

}  // namespace
}  // namespace shadowbench::claims
