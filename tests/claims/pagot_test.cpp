#include "claims/pagot.h"

#include <gtest/gtest.h>

#include <vector>

namespace shadowbench::claims::pagot {
namespace {

Crossing of_line(double start, double slope) {
    std::vector<std::pair<double, double>> points;
    for (const double x : {0.25, 0.5, 1.0, 3.0, 4.0}) points.emplace_back(x, start + slope * x);
    return crossing_of(points);
}

TEST(Crossing, IsWhereTheLineThroughTheDifferencesIsZero) {
    const Crossing found = of_line(3.0, -2.0);
    EXPECT_NEAR(found.selection, 3.0, 1e-12);
    EXPECT_NEAR(found.saved, 2.0, 1e-12);
    EXPECT_NEAR(found.fragments, 1.5, 1e-12);
}

TEST(Crossing, IsTheLeastSquaresLines) {
    const std::pair<double, double> points[] = {{0.0, 1.0}, {1.0, 0.0}, {2.0, 1.0}, {3.0, -1.0}};
    const Crossing found = crossing_of(points);  // by hand: slope -0.5, mean (1.5, 0.25)
    EXPECT_NEAR(found.saved, 0.5, 1e-12);
    EXPECT_NEAR(found.selection, 1.0, 1e-12);
    EXPECT_NEAR(found.fragments, 2.0, 1e-12);
}

TEST(Crossing, MayBeNeverOrAtOnce) {
    EXPECT_EQ(of_line(3.0, 0.5).fragments, never);
    EXPECT_EQ(of_line(3.0, -1e-9).fragments, never);
    EXPECT_EQ(of_line(-1.0, -2.0).fragments, 0.0) << "selection costs nothing";
}

TEST(Kernels, AreRequestedAsThePaperDescribesThem) {
    EXPECT_EQ(request({1, 4}), R"({"type":"multi_depth","n":1,"select":"maximum","kernel":4})");
    EXPECT_EQ(request({3, 2}), R"({"type":"multi_depth","n":3,"select":"both","kernel":2})");
    EXPECT_EQ(title({3, 2}), "3-SM with 2 x 2");
}

}  // namespace
}  // namespace shadowbench::claims::pagot
