// Orders of segments, and curves that grow segment by segment.
#include "claims/salvi_streams.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/random.h"

namespace shadowbench::claims::salvi {
namespace {

// Two rays of random media, sorted by depth and submitted at random; the first has `count` segments.
rays::LightRays random_tile(std::uint64_t seed, std::uint32_t count) {
    base::Random random(seed);
    rays::LightRays tile;
    tile.width = 2;
    tile.height = 1;
    tile.begin = {0, count, 2 * count + 1};
    for (std::size_t r = 0; r < 2; ++r) {
        std::vector<float> fronts;
        for (std::uint32_t s = tile.begin[r]; s < tile.begin[r + 1]; ++s)
            fronts.push_back(static_cast<float>(random.uniform(0.0, 10.0)));
        std::sort(fronts.begin(), fronts.end());
        for (const float front : fronts) {
            tile.z_front.push_back(front);
            tile.z_back.push_back(front + static_cast<float>(random.uniform(0.1, 2.0)));
            tile.transmittance.push_back(static_cast<float>(random.uniform(0.5, 1.0)));
        }
    }
    tile.submission.resize(tile.z_front.size());
    std::iota(tile.submission.begin(), tile.submission.end(), 0u);
    for (std::size_t r = 0; r < 2; ++r)
        for (std::uint32_t k = tile.begin[r + 1] - tile.begin[r]; k > 1; --k)
            std::swap(tile.submission[tile.begin[r] + k - 1], tile.submission[tile.begin[r] + random.below(k)]);
    return tile;
}

TEST(SalviStreams, ShuffledSegmentsStayInTheirStretchAndRay) {
    const std::vector<rays::LightRays> tiles = {random_tile(1, 30), random_tile(2, 41)};
    for (const std::uint32_t window : {1u, 4u, 16u, ~0u}) {
        const auto result = shuffled(tiles, window, 5);
        std::size_t moved = 0;
        for (std::size_t t = 0; t < tiles.size(); ++t)
            for (std::size_t r = 0; r < 2; ++r)
                for (std::uint32_t first = tiles[t].begin[r]; first < tiles[t].begin[r + 1];) {
                    const std::uint32_t count = std::min(window, tiles[t].begin[r + 1] - first);
                    const auto stretch = [&](const rays::LightRays& tile) {
                        const auto begin = tile.submission.begin() + first;
                        return std::vector<std::uint32_t>(begin, begin + count);
                    };
                    std::vector<std::uint32_t> before = stretch(tiles[t]), after = stretch(result[t]);
                    for (std::uint32_t k = 0; k < count; ++k) moved += before[k] != after[k];
                    std::sort(before.begin(), before.end());
                    std::sort(after.begin(), after.end());
                    EXPECT_EQ(before, after) << "window " << window;
                    first += count;
                }
        if (window == 1)
            EXPECT_EQ(moved, 0u);
        else
            EXPECT_GT(moved, 50u) << "window " << window;
    }
}

TEST(SalviStreams, AnotherSeedIsAnotherOrder) {
    const std::vector<rays::LightRays> tiles = {random_tile(1, 30)};
    EXPECT_NE(shuffled(tiles, ~0u, 1)[0].submission, shuffled(tiles, ~0u, 2)[0].submission);
    EXPECT_EQ(shuffled(tiles, ~0u, 1)[0].submission, shuffled(tiles, ~0u, 1)[0].submission);
}

// The tile is the oracle: it is sorted. The number of moves is the number of inversions.
TEST(SalviStreams, InsertionSortFindsTheOrderOfDepthWithOneMoveForEachInversion) {
    const rays::LightRays tile = random_tile(3, 50);
    for (std::size_t r = 0; r < 2; ++r) {
        std::vector<Segment> sorted;
        const std::uint64_t moves = insertion_sort(tile, r, sorted);
        std::uint64_t inversions = 0;
        for (std::uint32_t a = tile.begin[r]; a < tile.begin[r + 1]; ++a)
            for (std::uint32_t b = a + 1; b < tile.begin[r + 1]; ++b)
                inversions += tile.submission[a] > tile.submission[b];
        EXPECT_EQ(moves, inversions);
        ASSERT_EQ(sorted.size(), tile.begin[r + 1] - tile.begin[r]);
        for (std::size_t s = 0; s < sorted.size(); ++s) {
            EXPECT_EQ(sorted[s].front, tile.z_front[tile.begin[r] + s]);
            EXPECT_EQ(sorted[s].back, tile.z_back[tile.begin[r] + s]);
            EXPECT_EQ(sorted[s].through, tile.transmittance[tile.begin[r] + s]);
        }
    }
}

TEST(SalviStreams, OneRayKeepsItsSegmentsInOrderOfDepthAndTheirSubmission) {
    const rays::LightRays tile = random_tile(4, 20);
    const std::vector<std::uint32_t> order = {33, 21, 40, 25};
    const rays::LightRays one = one_ray(tile, order);
    EXPECT_EQ(one.rays(), 1u);
    EXPECT_EQ(one.segments(), 4u);
    EXPECT_TRUE(std::is_sorted(one.z_front.begin(), one.z_front.end()));
    for (std::size_t k = 0; k < order.size(); ++k) {
        EXPECT_EQ(one.z_front[one.submission[k]], tile.z_front[order[k]]);
        EXPECT_EQ(one.z_back[one.submission[k]], tile.z_back[order[k]]);
        EXPECT_EQ(one.transmittance[one.submission[k]], tile.transmittance[order[k]]);
    }
}

// Behind all media the curve is the product of what they transmit, and in front of them 1. Where one medium ends before
// the next begins, it is exact at every end of both.
TEST(SalviStreams, AGrowingCurveIsExactAtItsEndsInEveryOrder) {
    const rays::LightRays tile = random_tile(5, 25);
    double product = 1.0;
    curves::Curve curve;
    for (std::uint32_t k = 0; k < 25; ++k) {
        const std::uint32_t s = tile.submission[k];
        curve = with_medium(curve, {tile.z_front[s], tile.z_back[s], tile.transmittance[s]});
        product *= tile.transmittance[s];
        EXPECT_TRUE(curves::is_visibility(curve));
        EXPECT_EQ(curve.front().value, 1.0f);
        EXPECT_NEAR(curve.back().value, product, 1e-6);
    }
    EXPECT_EQ(curve.size(), 50u);
    const curves::Curve apart = with_medium(with_medium({}, {5.0f, 6.0f, 0.5f}), {1.0f, 3.0f, 0.25f});
    EXPECT_EQ(apart, (curves::Curve{{1.0f, 1.0f}, {3.0f, 0.25f}, {5.0f, 0.25f}, {6.0f, 0.125f}}));
}

// Inside another medium, both follow their own exponentials at the ends of either.
TEST(SalviStreams, AMediumAroundANodeFollowsItsExponential) {
    const curves::Curve curve = with_medium(with_medium({}, {1.0f, 2.0f, 0.5f}), {0.0f, 4.0f, 0.0625f});
    ASSERT_EQ(curve.size(), 4u);
    EXPECT_FLOAT_EQ(curve[1].value, 0.5f);            // 1 * exp(log(1/16) / 4)
    EXPECT_FLOAT_EQ(curve[2].value, 0.5f * 0.25f);    // behind the first, half way through the second
    EXPECT_FLOAT_EQ(curve[3].value, 0.5f * 0.0625f);  // behind both
}

}  // namespace
}  // namespace shadowbench::claims::salvi
