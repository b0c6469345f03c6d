#include "metrics/statistics.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "base/random.h"

namespace shadowbench::metrics {
namespace {

TEST(ErrorNorms, OfNothingAreZero) {
    const ErrorNorms norms = error_norms({});
    EXPECT_EQ(norms.max, 0.0);
    EXPECT_EQ(norms.p99, 0.0);
}

TEST(ErrorNorms, TakeTheSizeOfErrorsOfEitherSign) {
    const std::vector<double> errors{3.0, -4.0};
    const ErrorNorms norms = error_norms(errors);
    EXPECT_EQ(norms.max, 4.0);
    EXPECT_EQ(norms.mean, 3.5);
    EXPECT_DOUBLE_EQ(norms.rms, std::sqrt(12.5));
    EXPECT_EQ(norms.p99, 4.0);
}

// Nearest rank: the value that 99 % do not exceed, one of the data.
TEST(ErrorNorms, The99thPercentileIsANearestRank) {
    std::vector<double> errors;
    for (int i = 1; i <= 100; ++i) errors.push_back(i % 2 ? i : -i);
    EXPECT_EQ(error_norms(errors).p99, 99.0);
    errors.push_back(101.0);
    EXPECT_EQ(error_norms(errors).p99, 100.0);
    errors.resize(99);
    EXPECT_EQ(error_norms(errors).p99, 99.0);
}

// std::max(0, NaN) is 0: a technique that answers NaN would pass as perfect.
TEST(ErrorNorms, ANaNIsAnInfiniteError) {
    const std::vector<double> errors{0.0, std::numeric_limits<double>::quiet_NaN(), 0.0};
    const ErrorNorms norms = error_norms(errors);
    EXPECT_TRUE(std::isinf(norms.max));
    EXPECT_TRUE(std::isinf(norms.mean));
    EXPECT_TRUE(std::isinf(norms.rms));
    EXPECT_TRUE(std::isinf(norms.p99));
}

TEST(ErrorNorms, AMillionSmallErrorsDoNotVanishBesideALargeOne) {
    std::vector<double> errors(1'000'000, 1e-17);
    errors[0] = 1.0;
    EXPECT_DOUBLE_EQ(error_norms(errors).mean, (1.0 + 999'999e-17) / 1e6);
}

TEST(Median, IsTheMiddleOrTheMeanOfTheTwoMiddleValues) {
    EXPECT_EQ(median(std::vector<double>{5}), 5.0);
    EXPECT_EQ(median(std::vector<double>{9, 1, 5}), 5.0);
    EXPECT_EQ(median(std::vector<double>{9, 1, 5, 3}), 4.0);
    EXPECT_EQ(median(std::vector<double>{2, 1}), 1.5);
}

TEST(MedianInterval, OfOneValueIsThatValue) {
    const std::vector<double> sample{7.0};
    EXPECT_EQ(median_interval(sample).low, 7.0);
    EXPECT_EQ(median_interval(sample).high, 7.0);
}

// Scoring a result file again must give the same interval.
TEST(MedianInterval, IsTheSameForTheSameSeed) {
    const std::vector<double> sample{1, 2, 3, 5, 8, 13, 21, 34};
    const Interval a = median_interval(sample), b = median_interval(sample);
    EXPECT_EQ(a.low, b.low);
    EXPECT_EQ(a.high, b.high);
    EXPECT_LE(a.low, median(sample));
    EXPECT_GE(a.high, median(sample));
}

TEST(MedianInterval, WidensWithConfidence) {
    const std::vector<double> sample{1, 2, 3, 5, 8, 13, 21, 34, 55};
    const Interval narrow = median_interval(sample, 0.5), wide = median_interval(sample, 0.99);
    EXPECT_LT(wide.low, narrow.low);
    EXPECT_GT(wide.high, narrow.high);
}

// An interval of the mean, or of the sample itself, would cover too rarely or nearly always.
TEST(MedianInterval, CoversTheTrueMedianAboutAsOftenAsItShould) {
    base::Random random(1);
    int covered = 0;
    constexpr int kRounds = 200;
    for (int round = 0; round < kRounds; ++round) {
        std::vector<double> sample;
        for (int i = 0; i < 25; ++i) sample.push_back(-std::log(1.0 - random.uniform()));
        const Interval interval = median_interval(sample, 0.95, static_cast<std::uint64_t>(round));
        covered += interval.low <= std::log(2.0) && std::log(2.0) <= interval.high;
    }
    EXPECT_GT(covered, kRounds * 88 / 100);
    EXPECT_LT(covered, kRounds);
}

// The share of all 2^n ways in which n values fall on either side of the median with at least `least` on each side.
double share_inside(int n, int least) {
    int inside = 0;
    for (unsigned ways = 0; ways < (1u << n); ++ways) {
        const int below = std::popcount(ways);
        inside += below >= least && n - below >= least;
    }
    return static_cast<double>(inside) / static_cast<double>(1u << n);
}

TEST(OrderInterval, IsTheNarrowestPairThatHoldsTheMedianOftenEnough) {
    base::Random random(5);
    for (int n = 1; n <= 16; ++n)
        for (const double confidence : {0.5, 0.9, 0.95, 0.99}) {
            std::vector<double> sample;
            for (int i = 0; i < n; ++i) sample.push_back(random.uniform());
            const Interval interval = order_interval(sample, confidence);
            int low = 0, high = 0;  // ranks from either end, from 1
            for (const double value : sample) low += value <= interval.low, high += value >= interval.high;
            EXPECT_EQ(low, high) << n;
            if (low > 1) {
                EXPECT_GE(share_inside(n, low), confidence) << n;
            }
            if (2 * (low + 1) <= n) {
                EXPECT_LT(share_inside(n, low + 1), confidence) << n << " " << confidence;
            }
            EXPECT_LE(interval.low, median(sample));
            EXPECT_GE(interval.high, median(sample));
        }
}

TEST(OrderInterval, KnownRanks) {
    const auto of = [](int n) {
        std::vector<double> sample;
        for (int i = n; i > 0; --i) sample.push_back(i);
        return order_interval(sample);
    };
    EXPECT_EQ(of(1).low, 1.0);
    EXPECT_EQ(of(1).high, 1.0);
    EXPECT_EQ(of(5).high, 5.0) << "the whole range: 94 %";
    EXPECT_EQ(of(7).low, 1.0);
    EXPECT_EQ(of(9).low, 2.0);
    EXPECT_EQ(of(9).high, 8.0);
    EXPECT_EQ(of(31).low, 10.0);
    EXPECT_EQ(of(31).high, 22.0);
    EXPECT_EQ(of(1000).low, 469.0) << "a table of the binomial distribution";
}

}  // namespace
}  // namespace shadowbench::metrics
