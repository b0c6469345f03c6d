#include "claims/intervals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace shadowbench::claims {
namespace {

TEST(Intervals, AnExactLawHasAnExponentWithoutDoubt) {
    std::vector<std::pair<double, double>> points;
    for (const double x : {1.0, 2.0, 8.0}) points.emplace_back(x, 5.0 * std::pow(x, -0.5));
    const Value exponent = fitted_exponent(points);
    EXPECT_NEAR(exponent.value, -0.5, 1e-12);
    EXPECT_NEAR(exponent.low, -0.5, 1e-6);
    EXPECT_NEAR(exponent.high, -0.5, 1e-6);
}

// Three points at u = -1, 0, 1 with residuals e (1, -2, 1): the standard error of the slope is sqrt(6 e^2 / 1 / 2), and
// Student's t with one degree of freedom is 12.706.
TEST(Intervals, TheIntervalOfAFitIsStudents) {
    const double e = 0.01;
    std::vector<std::pair<double, double>> points;
    for (const auto& [u, residual] : {std::pair{-1.0, e}, std::pair{0.0, -2.0 * e}, std::pair{1.0, e}})
        points.emplace_back(std::exp(u), std::exp(0.25 * u + residual));
    const Value exponent = fitted_exponent(points);
    EXPECT_NEAR(exponent.value, 0.25, 1e-12);
    EXPECT_NEAR(exponent.high - exponent.value, 12.706 * std::sqrt(3.0) * e, 1e-5);
    EXPECT_NEAR(exponent.value - exponent.low, 12.706 * std::sqrt(3.0) * e, 1e-5);
}

// Four values with mean 5 and standard deviation 2: 5 -+ 3.1824 * 2 / sqrt 4.
TEST(Intervals, TheIntervalOfAMeanIsStudents) {
    const std::vector<double> sample{5.0 - std::sqrt(6.0), 5.0, 5.0, 5.0 + std::sqrt(6.0)};
    const Value mean = mean_of(sample);
    EXPECT_NEAR(mean.value, 5.0, 1e-12);
    EXPECT_NEAR(mean.low, 5.0 - 3.1824, 1e-3);
    EXPECT_NEAR(mean.high, 5.0 + 3.1824, 1e-3);
}

TEST(Intervals, ARatioOfPairsDoesNotHoldWhatBothShare) {
    const std::vector<double> one{1.0, 10.0, 100.0}, other{2.0, 20.0, 200.0};
    const Value ratio = mean_ratio_of(one, other);
    EXPECT_EQ(ratio.value, 0.5);
    EXPECT_EQ(ratio.low, 0.5);
    EXPECT_EQ(ratio.high, 0.5);
}

}  // namespace
}  // namespace shadowbench::claims
