#include "techniques/depth/cell_subset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "techniques/built.h"

namespace shadowbench::techniques {
namespace {

using rays::testing::directional;
using rays::testing::quad;
using testing::build;

std::set<std::uint64_t> subset(std::uint64_t count, int wanted, std::uint64_t key) {
    std::set<std::uint64_t> numbers;
    const int visited = for_each_of_subset(count, wanted, key, [&](std::uint64_t number, std::uint64_t) {
        EXPECT_LT(number, count);
        EXPECT_TRUE(numbers.insert(number).second) << number << " twice";
    });
    EXPECT_EQ(static_cast<std::size_t>(visited), numbers.size());
    return numbers;
}

TEST(Subset, HasTheNumberAskedForOrAll) {
    for (const int wanted : {1, 2, 3, 400, 4095, 4096})
        for (const std::uint64_t count : {1ull, 2ull, 3ull, 400ull, 401ull, 4096ull, 1ull << 20, 1ull << 50})
            EXPECT_EQ(subset(count, wanted, base::hash(count, static_cast<std::uint64_t>(wanted))).size(),
                      std::min<std::uint64_t>(count, static_cast<std::uint64_t>(wanted)));
}

// All ten pairs of five numbers, by brute force.
TEST(Subset, AllSubsetsAreEquallyLikely) {
    constexpr int draws = 20000;
    std::map<std::set<std::uint64_t>, int> seen;
    for (std::uint64_t key = 0; key < draws; ++key) ++seen[subset(5, 2, base::hash(key))];
    ASSERT_EQ(seen.size(), 10u);
    double chi_squared = 0.0;
    for (const auto& [numbers, times] : seen) {
        const double expected = draws / 10.0;
        chi_squared += (times - expected) * (times - expected) / expected;
    }
    EXPECT_LT(chi_squared, 27.9) << "exceeded once in a thousand with 9 degrees of freedom";
}

TEST(Subset, TheMiddlesOfCellsInsideARegion) {
    const auto expect = [](float from, float to, float at, double first, std::uint64_t count) {
        const Middles m = middles(from, to, at);
        EXPECT_EQ(m.first, first) << from << " to " << to;
        EXPECT_EQ(m.count, count) << from << " to " << to;
    };
    expect(2.0f, 6.0f, 4.0f, 2.5, 4);
    expect(2.4f, 6.4f, 4.4f, 2.5, 4);
    expect(2.5f, 6.5f, 4.5f, 2.5, 4);
    expect(2.6f, 6.6f, 4.6f, 3.5, 4);
    expect(2.6f, 3.4f, 3.0f, 3.0, 1);
    expect(-3.0f, 1.0f, -1.0f, -2.5, 4);
    expect(-1e30f, 1e30f, 0.0f, -16777215.5, 33554432);
}

// A region of 7 x 5 cells, each cell with the same probability, and positions in the middle of cells.
TEST(Subset, CellsOfARegionAreEquallyLikely) {
    const Extent region{10.2f, 17.2f, 3.9f, 8.9f};
    constexpr int draws = 7000, wanted = 5;
    std::map<std::pair<float, float>, int> seen;
    double low_u = 1.0, high_u = 0.0, sum_u = 0.0;
    for (std::uint64_t key = 0; key < draws; ++key)
        EXPECT_EQ(for_each_in_subset(region, 13.7f, 6.4f, wanted, base::hash(key),
                                     [&](float x, float y, float u) {
                                         ++seen[{x, y}];
                                         low_u = std::min<double>(low_u, u);
                                         high_u = std::max<double>(high_u, u);
                                         sum_u += u;
                                     }),
                  wanted);
    EXPECT_EQ(seen.size(), 35u);
    for (int x = 10; x < 17; ++x)
        for (int y = 4; y < 9; ++y) {
            const double times = seen[{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}];
            EXPECT_NEAR(times, draws * wanted / 35.0, 5.0 * std::sqrt(1000.0)) << x << ", " << y;
        }
    EXPECT_NEAR(sum_u / (draws * wanted), 0.5, 0.01);
    EXPECT_LT(low_u, 0.001);
    EXPECT_GT(high_u, 0.999);
    EXPECT_LT(high_u, 1.0);
}

// A wall over the left half of the map.
testing::Built half_wall(const char* parameters) {
    scene::Scene scene;
    scene.objects.push_back(quad({-1, -1, 0}, {1, 0, 0}, {0, 2, 0}));
    return build(find("pcf", ""), std::move(scene), directional(), rays::testing::rays(64, 1), parameters);
}

TEST(Subset, WithEnoughSamplesALookupIsTheMeanOfItsCells) {
    const auto b = half_wall(R"({"placement": "subset", "num_samples": 64, "res_factor": 1, "min_size": 0})");
    for (float x = 26.3f; x < 38.0f; x += 0.81f) {
        const int begin = static_cast<int>(std::ceil(x - 4.0f - 0.5f));
        int lit = 0;
        for (int cell = begin; cell < begin + 8; ++cell) lit += cell >= 32;
        EXPECT_FLOAT_EQ(b.lookup(x, 30.2f, 10.0f, 8.0f), static_cast<float>(lit) / 8.0f) << x;
    }
}

// Depth changes the random numbers of a lookup, but not its answer's distribution: k cells of M without replacement
// have the mean p and the variance p (1 - p) / k (M - k) / (M - 1).
TEST(Subset, TheNoiseIsThatOfDrawingWithoutReplacement) {
    const auto b = half_wall(R"({"placement": "subset", "num_samples": 40, "res_factor": 1, "min_size": 0})");
    constexpr int lookups = 20000;
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < lookups; ++i) {
        const double v = b.lookup(34.0f, 30.0f, 10.0f + 0.001f * static_cast<float>(i), 8.0f);
        sum += v;
        squares += v * v;
    }
    const double mean = sum / lookups, variance = squares / lookups - mean * mean;
    const double p = 0.75, expected = p * (1.0 - p) / 40.0 * (64.0 - 40.0) / (64.0 - 1.0);
    EXPECT_NEAR(mean, p, 4.0 * std::sqrt(expected / lookups));
    EXPECT_NEAR(variance, expected, 0.05 * expected);
}

TEST(Subset, TheSameLookupHasTheSameAnswer) {
    const auto a = half_wall(R"({"placement": "subset", "num_samples": 9})");
    const auto b = half_wall(R"({"placement": "subset", "num_samples": 9})");
    for (float x = 20.0f; x < 44.0f; x += 0.73f)
        EXPECT_EQ(a.lookup(x, 30.0f, 10.0f, 4.0f), b.lookup(x, 30.0f, 10.0f, 4.0f));
}

}  // namespace
}  // namespace shadowbench::techniques
