#include "claims/fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace shadowbench::claims {
namespace {

TEST(Fit, FindsTheExponentOfAPowerLaw) {
    std::vector<std::pair<double, double>> points;
    for (const double x : {16.0, 36.0, 64.0, 144.0, 256.0}) points.emplace_back(x, 3.0 * std::pow(x, 0.25));
    const PowerLaw law = fit_power(points);
    EXPECT_NEAR(law.exponent, 0.25, 1e-12);
    EXPECT_NEAR(law.factor, 3.0, 1e-9);
    EXPECT_NEAR(law.standard_error, 0.0, 1e-7);
}

TEST(Fit, ScatterIncreasesTheStandardError) {
    // y = x^1 times e^0.1, e^-0.1, ... : residuals of 0.1; the error of a slope is sigma / sqrt(sum of squares of x).
    std::vector<std::pair<double, double>> points;
    double squares = 0.0;
    for (int i = -2; i <= 2; ++i) {
        points.emplace_back(std::exp(i), std::exp(i + (i % 2 == 0 ? 0.1 : -0.1)));
        squares += i * i;
    }
    const PowerLaw law = fit_power(points);
    EXPECT_NEAR(law.exponent, 1.0, 1e-12) << "the scatter is even in x";
    double residuals = 0.0;
    const double mean = 0.02;  // of 0.1, -0.1, 0.1, -0.1, 0.1
    for (const double r : {0.1, -0.1, 0.1, -0.1, 0.1}) residuals += (r - mean) * (r - mean);
    EXPECT_NEAR(law.standard_error, std::sqrt(residuals / 3.0 / squares), 1e-12);
}

}  // namespace
}  // namespace shadowbench::claims
