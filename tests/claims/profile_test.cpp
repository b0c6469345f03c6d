#include "claims/profile.h"

#include <gtest/gtest.h>

#include <vector>

namespace shadowbench::claims {
namespace {

TEST(Profile, ReachesALevelBetweenTwoValues) {
    const std::vector<double> rising{0.0, 0.0, 0.2, 0.6, 1.0, 1.0};
    EXPECT_DOUBLE_EQ(first_reached(rising, 0.1), 1.5);
    EXPECT_DOUBLE_EQ(first_reached(rising, 0.2), 2.0);
    EXPECT_DOUBLE_EQ(first_reached(rising, 0.9), 3.75);
    EXPECT_DOUBLE_EQ(first_reached(rising, 2.0), 6.0) << "never";
}

TEST(Profile, TheFirstPlaceCountsWhereItFallsAgain) {
    EXPECT_DOUBLE_EQ(first_reached(std::vector{0.0, 0.5, 0.1, 0.5}, 0.25), 0.5);
}

}  // namespace
}  // namespace shadowbench::claims
