#include "base/random.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <set>
#include <vector>

namespace shadowbench::base {
namespace {

// Stored results name a seed: the numbers of a seed must never change.
TEST(Random, NumbersOfAKeyAreFixedForEver) {
    // First outputs of SplitMix64 with state 0, from its reference implementation.
    EXPECT_EQ(mix(0), 0xe220a8397b1dcdafull);
    EXPECT_EQ(mix(0x9e3779b97f4a7c15ull), 0x6e789e6aa1b965f4ull);
    Random a(42), b(42);
    for (int i = 0; i < 100; ++i) ASSERT_EQ(a.bits(), b.bits());
}

TEST(Random, UniformStaysBelowOneAndFillsTheUnit) {
    EXPECT_EQ(to_unit(0), 0.0);
    EXPECT_LT(to_unit(~0ull), 1.0);
    // Chi-square of 64 bins: 63 +- 11.2; five sigmas.
    Random random(1);
    std::vector<int> bins(64);
    constexpr int kDraws = 64000;
    for (int i = 0; i < kDraws; ++i) ++bins[static_cast<std::size_t>(random.uniform() * 64)];
    double chi = 0.0;
    for (const int count : bins) chi += (count - 1000.0) * (count - 1000.0) / 1000.0;
    EXPECT_LT(chi, 63 + 5 * 11.2);
    EXPECT_GT(chi, 63 - 5 * 11.2);
}

TEST(Random, BelowReachesEveryValueEquallyAndNoOther) {
    Random random(2);
    std::vector<int> counts(7);
    for (int i = 0; i < 70000; ++i) ++counts.at(random.below(7));
    for (const int count : counts) EXPECT_NEAR(count, 10000, 5 * std::sqrt(10000.0));
    EXPECT_EQ(random.below(1), 0u);
}

TEST(Random, UniformBetweenBoundsHasTheirMean) {
    Random random(3);
    double sum = 0.0;
    for (int i = 0; i < 10000; ++i) {
        const double x = random.uniform(-2, 4);
        ASSERT_GE(x, -2);
        ASSERT_LT(x, 4);
        sum += x;
    }
    EXPECT_NEAR(sum / 10000, 1.0, 5 * 6 / std::sqrt(12.0 * 10000));
}

// Neighbouring pixels and samples are neighbouring keys: without avalanche their jitter would be alike.
TEST(Hash, EveryBitOfEveryWordOfTheKeyFlipsHalfTheBits) {
    for (int word = 0; word < 4; ++word) {
        double flipped = 0.0;
        for (int bit = 0; bit < 64; ++bit) {
            std::uint64_t key[4] = {11, 22, 33, 44};
            const std::uint64_t before = hash(key[0], key[1], key[2], key[3]);
            key[word] ^= 1ull << bit;
            flipped += std::popcount(before ^ hash(key[0], key[1], key[2], key[3]));
        }
        EXPECT_NEAR(flipped / 64, 32.0, 5 * 4.0 / 8.0) << "word " << word;
    }
}

TEST(Hash, KeysOfAGridDoNotCollideAndOrderMatters) {
    std::set<std::uint64_t> seen;
    for (std::uint64_t i = 0; i < 100; ++i)
        for (std::uint64_t k = 0; k < 100; ++k) seen.insert(hash(7, i, k));
    EXPECT_EQ(seen.size(), 10000u);
    EXPECT_NE(hash(1, 2), hash(2, 1));
}

}  // namespace
}  // namespace shadowbench::base
