#include "metrics/drift.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/random.h"

namespace shadowbench::metrics {
namespace {

double score_of(const std::vector<double>& values) {
    double score = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i)
        for (std::size_t j = i + 1; j < values.size(); ++j) score += (values[j] > values[i]) - (values[j] < values[i]);
    return score;
}

TEST(Trend, IsExactForFewValues) {
    base::Random random(3);
    for (int round = 0; round < 40; ++round) {
        std::vector<double> values(2 + random.below(5));
        for (double& v : values) v = random.uniform();
        std::vector<double> order(values.size());
        std::iota(order.begin(), order.end(), 0.0);
        int all = 0, beyond = 0;
        do {
            ++all;
            beyond += std::abs(score_of(order)) >= std::abs(score_of(values));
        } while (std::next_permutation(order.begin(), order.end()));
        EXPECT_NEAR(trend_p(values), static_cast<double>(beyond) / all, 1e-12);
    }
}

// Kendall 1970, appendix table 1: n = 10, score 21, one-sided probability 0.036.
TEST(Trend, AgreesWithThePublishedTable) {
    const std::vector<double> values{5, 4, 3, 2, 1, 7, 6, 8, 10, 9};  // 10 + 1 + 1 pairs fall, 33 rise
    ASSERT_EQ(score_of(values), 21.0);
    EXPECT_NEAR(trend_p(values), 2.0 * 0.036, 0.001);
}

TEST(Trend, IsAbsentInConstantValues) {
    EXPECT_EQ(trend_p(std::vector<double>(10, 4.0)), 1.0);
    EXPECT_EQ(trend_p(std::vector<double>{}), 1.0);
    EXPECT_EQ(trend_p(std::vector<double>{1.0}), 1.0);
}

TEST(RobustLine, GoesThroughALine) {
    const Line line = robust_line(std::vector<double>{3, 5, 7, 9});
    EXPECT_DOUBLE_EQ(line.first, 3.0);
    EXPECT_DOUBLE_EQ(line.last, 9.0);
}

TEST(RobustLine, IsNotMovedByOneOutlier) {
    const Line line = robust_line(std::vector<double>{1, 2, 3, 1000, 5, 6, 7});
    EXPECT_DOUBLE_EQ(line.first, 1.0);
    EXPECT_DOUBLE_EQ(line.last, 7.0);
}

// 1 % more in every result: too little for a comparison of neighbours.
TEST(Drift, FindsChangesTooSlowForNeighbours) {
    base::Random random(5);
    std::vector<double> values;
    for (int i = 0; i < 10; ++i) values.push_back(std::pow(1.01, i) * random.uniform(0.998, 1.002));
    const auto line = drift(values, 0.05);
    ASSERT_TRUE(line);
    EXPECT_NEAR(line->last / line->first, std::pow(1.01, 9), 0.01);
    EXPECT_FALSE(drift(values, 0.15));  // below the least change
}

TEST(Drift, FindsAFall) {
    EXPECT_TRUE(drift(std::vector<double>{10, 9, 8, 7, 6, 5}, 0.05));
    EXPECT_TRUE(drift(std::vector<double>{5, 4, 3, 2, 1, 0}, 0.05));
}

TEST(Drift, IsAbsentInFewValuesAndWithOneOutlier) {
    EXPECT_FALSE(drift(std::vector<double>{1, 1, 1, 1, 1, 1, 1, 1, 1, 2}, 0.0));
    EXPECT_FALSE(drift(std::vector<double>{1, 2, 3, 4}, 0.0));
    EXPECT_FALSE(drift(std::vector<double>(10, 7.0), 0.0));
    EXPECT_FALSE(drift(std::vector<double>{}, 0.0));
}

TEST(Drift, IsRareInNoise) {
    base::Random random(9);
    int found = 0;
    for (int round = 0; round < 2000; ++round) {
        std::vector<double> values(10);
        for (double& v : values) v = random.uniform(0.95, 1.05);
        found += drift(values, 0.05).has_value();
    }
    EXPECT_LE(found, 20);
}

}  // namespace
}  // namespace shadowbench::metrics
