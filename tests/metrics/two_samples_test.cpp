#include "metrics/two_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/random.h"

namespace shadowbench::metrics {
namespace {

double normal(base::Random& random) {
    return std::sqrt(-2.0 * std::log(1.0 - random.uniform())) * std::cos(2.0 * M_PI * random.uniform());
}

std::vector<double> ranks_of(const std::vector<double>& values) {
    std::vector<double> ranks;
    for (const double value : values) {
        double below = 0.0, equal = 0.0;
        for (const double other : values) {
            below += other < value;
            equal += other == value;
        }
        ranks.push_back(below + 0.5 * (equal + 1.0));
    }
    return ranks;
}

// Counts one by one all choices of the values of the upper sample, or of the positive differences.
double counted_rank_sum_p(const std::vector<double>& above, const std::vector<double>& below) {
    std::vector<double> all = above;
    all.insert(all.end(), below.begin(), below.end());
    const std::vector<double> ranks = ranks_of(all);
    const double seen = std::accumulate(ranks.begin(), ranks.begin() + static_cast<std::ptrdiff_t>(above.size()), 0.0);
    int choices = 0, beyond = 0;
    for (unsigned set = 0; set < (1u << all.size()); ++set) {
        if (std::popcount(set) != static_cast<int>(above.size())) continue;
        double sum = 0.0;
        for (std::size_t i = 0; i < all.size(); ++i)
            if (set >> i & 1u) sum += ranks[i];
        ++choices;
        beyond += sum >= seen - 1e-9;
    }
    return static_cast<double>(beyond) / choices;
}

double counted_signed_rank_p(const std::vector<double>& differences) {
    std::vector<double> sizes;
    double seen = 0.0;
    for (const double d : differences)
        if (d != 0.0) sizes.push_back(std::abs(d));
    const std::vector<double> ranks = ranks_of(sizes);
    std::size_t i = 0;
    for (const double d : differences)
        if (d != 0.0) seen += d > 0.0 ? ranks[i++] : (++i, 0.0);
    int beyond = 0;
    for (unsigned set = 0; set < (1u << sizes.size()); ++set) {
        double sum = 0.0;
        for (std::size_t k = 0; k < sizes.size(); ++k)
            if (set >> k & 1u) sum += ranks[k];
        beyond += sum >= seen - 1e-9;
    }
    return static_cast<double>(beyond) / static_cast<double>(1u << sizes.size());
}

TEST(RankSum, IsExactForFewValuesWithAndWithoutTies) {
    base::Random random(7);
    for (int round = 0; round < 200; ++round) {
        std::vector<double> above(1 + random.below(6)), below(1 + random.below(6));
        const std::uint64_t values = round % 2 ? 5 : 1000;  // every second round full of ties
        for (double& v : above) v = static_cast<double>(random.below(values));
        for (double& v : below) v = static_cast<double>(random.below(values));
        EXPECT_NEAR(rank_sum_p(above, below), counted_rank_sum_p(above, below), 1e-12);
    }
}

// Mann and Whitney 1947, table I, n = m = 4: P(U <= 0) = 0.014, P(U <= 1) = 0.029.
TEST(RankSum, AgreesWithThePublishedTables) {
    EXPECT_NEAR(rank_sum_p(std::vector<double>{4, 6, 7, 8}, std::vector<double>{1, 2, 3, 5}), 2.0 / 70.0, 1e-12);
    EXPECT_NEAR(rank_sum_p(std::vector<double>{5, 6, 7, 8}, std::vector<double>{1, 2, 3, 4}), 1.0 / 70.0, 1e-12);
}

TEST(RankSum, TheApproximationMeetsTheExactProbability) {
    base::Random random(11);
    std::vector<double> above, below;
    for (int i = 0; i < 40; ++i) {
        above.push_back(normal(random) + 0.4);
        below.push_back(normal(random));
    }
    const double exact = rank_sum_p(above, below);
    above.push_back(0.2);  // one more: the approximation
    EXPECT_NEAR(rank_sum_p(above, below), exact, 0.15 * exact);
    EXPECT_LT(exact, 0.2);
}

TEST(RankSum, OfEqualOrEmptySamplesShowsNothing) {
    EXPECT_EQ(rank_sum_p(std::vector<double>{}, std::vector<double>{1}), 1.0);
    EXPECT_EQ(rank_sum_p(std::vector<double>(5, 3.0), std::vector<double>(5, 3.0)), 1.0);
    EXPECT_EQ(rank_sum_p(std::vector<double>(50, 3.0), std::vector<double>(50, 3.0)), 1.0);
}

TEST(SignedRank, IsExactForFewDifferencesWithTiesAndZeros) {
    base::Random random(13);
    for (int round = 0; round < 200; ++round) {
        std::vector<double> differences(1 + random.below(10));
        for (double& d : differences)
            d = round % 2 ? static_cast<double>(random.below(7)) - 3.0 : random.uniform(-1.0, 2.0);
        if (std::count(differences.begin(), differences.end(), 0.0) == static_cast<long>(differences.size())) continue;
        EXPECT_NEAR(signed_rank_p(differences), counted_signed_rank_p(differences), 1e-12);
    }
}

// Wilcoxon 1945, as tabulated since: n = 20, rank sum of one sign at most 52 has a probability of 0.024.
TEST(SignedRank, AgreesWithThePublishedTable) {
    std::vector<double> differences;
    for (int i = 1; i <= 20; ++i) differences.push_back(i);
    for (const int i : {20, 19, 13}) differences[static_cast<std::size_t>(i - 1)] *= -1.0;  // 52
    EXPECT_NEAR(signed_rank_p(differences), 0.0242, 0.0002);
}

TEST(SignedRank, TheApproximationMeetsTheExactProbability) {
    base::Random random(17);
    std::vector<double> differences;
    for (int i = 0; i < 80; ++i) differences.push_back(normal(random) + 0.2);
    const double exact = signed_rank_p(differences);
    differences.push_back(0.2);
    EXPECT_NEAR(signed_rank_p(differences), exact, 0.15 * exact);
    EXPECT_EQ(signed_rank_p(std::vector<double>(4, 0.0)), 1.0);
}

// 20 pairs that all lie above: 2^-20, far below the level needed for thousands of cells.
TEST(SignedRank, ManyClearPairsLeaveRoomForManyCells) {
    EXPECT_NEAR(signed_rank_p(std::vector<double>(20, 0.1)), std::pow(2.0, -20), 1e-12);
}

TEST(Holm, EnlargesTheSmallestMost) {
    const std::vector<double> adjusted = holm(std::vector<double>{0.01, 0.04, 0.03, 0.005});
    EXPECT_DOUBLE_EQ(adjusted[3], 0.02);
    EXPECT_DOUBLE_EQ(adjusted[0], 0.03);
    EXPECT_DOUBLE_EQ(adjusted[2], 0.06);
    EXPECT_DOUBLE_EQ(adjusted[1], 0.06);  // never below that of a smaller p
    EXPECT_EQ(holm(std::vector<double>{0.9, 0.8})[0], 1.0);
    EXPECT_TRUE(holm({}).empty());
}

// Of 100 true null hypotheses, any is called false in at most about 5 % of 1,000 rounds.
TEST(Holm, HoldsTheChanceOfAnyFalseAlarm) {
    base::Random random(19);
    int alarms = 0;
    for (int round = 0; round < 1000; ++round) {
        std::vector<double> p(100);
        for (double& value : p) value = random.uniform();
        const std::vector<double> adjusted = holm(p);
        alarms += *std::min_element(adjusted.begin(), adjusted.end()) <= 0.05;
    }
    EXPECT_GE(alarms, 30);
    EXPECT_LE(alarms, 70);
}

TEST(MedianRatioInterval, OfConstantSamplesIsTheirRatio) {
    const Interval interval = median_ratio_interval(std::vector<double>(5, 2.0), std::vector<double>(4, 3.0));
    EXPECT_EQ(interval.low, 1.5);
    EXPECT_EQ(interval.high, 1.5);
}

// The intervals hold the true ratio about as often as they should; with the fewest processes in 92.9 % of rounds.
TEST(MedianRatioInterval, CoversTheTrueRatio) {
    for (const std::size_t size : {4, 7, 20}) {
        base::Random random(23 + size);
        int covered = 0;
        for (int round = 0; round < 1000; ++round) {
            std::vector<double> baseline(size), current(size);
            for (double& v : baseline) v = std::exp(0.05 * normal(random));
            for (double& v : current) v = 1.1 * std::exp(0.05 * normal(random));
            const Interval interval = median_ratio_interval(baseline, current);
            covered += interval.low <= 1.1 && 1.1 <= interval.high;
        }
        EXPECT_GE(covered, 920) << size;
        EXPECT_LE(covered, 995) << size;
    }
}

}  // namespace
}  // namespace shadowbench::metrics
