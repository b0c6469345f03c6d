#include "claims/equal_error.h"

#include <gtest/gtest.h>

#include <vector>

namespace shadowbench::claims {
namespace {

// The error halves each time the cost grows fourfold, as that of N independent samples does.
const std::vector<CostAtError> samples{
    {exactly(0.4), exactly(1.0)}, {exactly(0.2), exactly(4.0)}, {exactly(0.1), exactly(16.0)}};

TEST(EqualError, TheCostFollowsThePowerLaw) {
    EXPECT_NEAR(cost_at(exactly(0.2), samples).value, 4.0, 1e-12);
    EXPECT_NEAR(cost_at(exactly(0.2 / 1.1), samples).value, 4.0 * 1.21, 1e-12);
    EXPECT_NEAR(cost_at(exactly(0.3), samples).value, 16.0 / 9.0, 1e-12);
}

TEST(EqualError, AnErrorBeyondTheSettingsCostsAsTheNearest) {
    EXPECT_EQ(cost_at(exactly(0.9), samples).value, 1.0);
    EXPECT_NEAR(cost_at(exactly(0.01), samples).value, 16.0, 1e-12);
}

TEST(EqualError, AnIntervalOfTheErrorIsOneOfTheCost) {
    const Value cost = cost_at({0.2, 0.1, 0.4}, samples);
    EXPECT_NEAR(cost.value, 4.0, 1e-12);
    EXPECT_NEAR(cost.low, 1.0, 1e-12) << "a larger error costs less";
    EXPECT_NEAR(cost.high, 16.0, 1e-12);
}

// Errors known within a factor of two are costs known within a factor of four, wherever the doubt is.
TEST(EqualError, TheDoubtOfTheSettingsCountsToo) {
    std::vector<CostAtError> doubtful = samples;
    for (CostAtError& setting : doubtful) {
        setting.error.low = 0.5 * setting.error.value;
        setting.error.high = 2.0 * setting.error.value;
        setting.cost.high = 1.5 * setting.cost.value;
    }
    const Value cost = cost_at(exactly(0.2), doubtful);
    EXPECT_NEAR(cost.value, 4.0, 1e-12);
    EXPECT_NEAR(cost.low, 1.0, 1e-12);
    EXPECT_NEAR(cost.high, 1.5 * 16.0, 1e-9);
}

}  // namespace
}  // namespace shadowbench::claims
