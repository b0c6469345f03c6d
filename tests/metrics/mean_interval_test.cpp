#include "metrics/student.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "base/random.h"
#include "metrics/ratio_of_sums.h"

namespace shadowbench::metrics {
namespace {

TEST(MeanInterval, OfAKnownSample) {
    // Mean 3, standard deviation sqrt(2.5), t of 4 degrees of freedom 2.7764451.
    const std::vector<double> sample{1, 2, 3, 4, 5};
    const Interval interval = mean_interval(sample);
    EXPECT_DOUBLE_EQ(mean_and_variance(sample).mean, 3.0);
    EXPECT_NEAR(interval.high, 3.0 + 2.7764451 * std::sqrt(2.5 / 5.0), 1e-6);
    EXPECT_NEAR(interval.low, 6.0 - interval.high, 1e-12);
}

// By hand: a sample of 4 of 100, sums 20 and 10, so the ratio is 2; deviations a - 2 b of 1, -1, 1, -1 with variance
// 4/3; the standard error is sqrt(0.96 * 4 * 4/3) / 10.
TEST(RatioInterval, OfAKnownSample) {
    const std::vector<double> a{3, 3, 7, 7}, b{1, 2, 3, 4};
    const double error = 1.959964 * std::sqrt(0.96 * 4.0 * 4.0 / 3.0) / 10.0;
    const Interval interval = ratio_interval(a, b, 100);
    EXPECT_NEAR(interval.low, 2.0 - error, 1e-12);
    EXPECT_NEAR(interval.high, 2.0 + error, 1e-12);
}

TEST(RatioInterval, HasNoWidthWhereNothingIsUnseen) {
    const std::vector<double> a{3, 3, 7, 7}, b{1, 2, 3, 4};
    EXPECT_EQ(ratio_interval(a, b, 4).low, 2.0);
    EXPECT_EQ(ratio_interval(a, b, 4).high, 2.0);
    const std::vector<double> twice{2, 4, 6, 8};
    EXPECT_EQ(ratio_interval(twice, b, 100).low, 2.0) << "every item has the same ratio";
}

TEST(MeanInterval, OfEqualValuesIsThatValue) {
    const Interval interval = mean_interval(std::vector<double>(5, 0.25));
    EXPECT_EQ(interval.low, 0.25);
    EXPECT_EQ(interval.high, 0.25);
}

TEST(MeanInterval, OfOneValueIsEverything) {
    const Interval interval = mean_interval(std::vector<double>{0.1});
    EXPECT_EQ(interval.low, -std::numeric_limits<double>::infinity());
    EXPECT_EQ(interval.high, std::numeric_limits<double>::infinity());
}

// 95 % of 10,000 intervals hold the mean, within four standard errors of that share.
TEST(MeanInterval, HoldsTheMeanOfNormalValuesInNineteenOfTwentyCases) {
    base::Random random(7);
    const auto normal = [&] {
        const double u = 1.0 - random.uniform(0.0, 1.0), v = random.uniform(0.0, 1.0);
        return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
    };
    for (const std::size_t count : {2u, 5u, 12u}) {
        int held = 0;
        for (int i = 0; i < 10000; ++i) {
            std::vector<double> sample(count);
            for (double& value : sample) value = normal();
            const Interval interval = mean_interval(sample);
            held += interval.low <= 0.0 && interval.high >= 0.0;
        }
        EXPECT_NEAR(held / 10000.0, 0.95, 0.009) << count;
    }
}

}  // namespace
}  // namespace shadowbench::metrics
