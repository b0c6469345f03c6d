#include "claims/growth.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shadowbench::claims {
namespace {

// Two seeds with the laws x^0.2 and x^0.3, and one x more with the first seed only.
Growth two_laws() {
    Growth growth;
    for (const double x : {1.0, 4.0, 16.0}) {
        growth.add(x, std::pow(x, 0.2));
        growth.add(x, std::pow(x, 0.3));
    }
    growth.add(64.0, std::pow(64.0, 0.2));
    return growth;
}

TEST(Growth, ItsPointsAreMeansOverSeeds) {
    const Growth growth = two_laws();
    ASSERT_EQ(growth.size(), 4u);
    EXPECT_EQ(growth.x(2), 16.0);
    EXPECT_EQ(growth.with_all_seeds(), 3u);
    const double low = std::pow(16.0, 0.2), high = std::pow(16.0, 0.3);
    EXPECT_NEAR(growth.at(2).value, 0.5 * (low + high), 1e-12);
    EXPECT_LT(growth.at(2).low, low) << "two values say little about their mean";
    EXPECT_EQ(growth.at(3).low, growth.at(3).high);
    EXPECT_EQ(growth.means()[2].second, growth.at(2).value);
}

TEST(Growth, EachSeedHasItsExponent) {
    const Value exponent = two_laws().exponent_over_seeds();
    EXPECT_NEAR(exponent.value, 0.25, 1e-12);
    EXPECT_NEAR(exponent.high - exponent.value, 12.706 * 0.05, 1e-3) << "Student's t with one degree of freedom";
    EXPECT_GT(two_laws().exponent().value, 0.2);
    EXPECT_LT(two_laws().exponent().value, 0.25);
}

}  // namespace
}  // namespace shadowbench::claims
