// The segments of many texels inserted side by side, against one stream after the other; and their random order.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "base/simd_path.h"
#include "techniques/any_rays.h"
#include "techniques/avsm/filling.h"
#include "techniques/avsm/stream.h"

namespace shadowbench::techniques {
namespace {

using testing::Segment;
using testing::Segments;

// Sets the path, and the best one again.
struct OnPath {
    explicit OnPath(base::SimdPath path) { base::set_simd_path(path); }
    ~OnPath() { base::set_simd_path(base::simd_paths().back()); }
};

void shuffle(Segments& segments, base::Random& random) {
    for (std::size_t k = segments.size(); k > 1; --k) std::swap(segments[k - 1], segments[random.below(k)]);
}

// The texel of one stream.
template <int nodes>
std::vector<float> streamed(const Segments& segments, float far_plane) {
    TransmittanceStream<nodes> stream(nodes, far_plane);
    for (const Segment& s : segments) stream.insert(s.front, s.back, s.through);
    std::vector<float> depths, values;
    stream.for_each([&](float depth, float value) {
        depths.push_back(depth);
        values.push_back(value);
    });
    depths.resize(nodes, far_plane);
    values.resize(nodes, values.back());
    depths.insert(depths.end(), values.begin(), values.end());
    return depths;
}

// The texels of rays side by side, `at_once` rows a call. Rays that are shorter than others have clear segments.
template <int nodes>
std::vector<std::vector<float>> side_by_side(const std::vector<Segments>& rays, float far_plane, std::size_t at_once) {
    std::size_t longest = 0;
    for (const Segments& ray : rays) longest = std::max(longest, ray.size());
    StreamLanes<nodes> streams(far_plane);
    SegmentRows rows;
    for (std::size_t first = 0; first < longest; first += at_once) {
        rows.count = at_once;
        for (std::size_t row = 0; row < at_once; ++row)
            for (std::size_t l = 0; l < stream_lanes; ++l) {
                const Segment s = first + row < rays[l].size() ? rays[l][first + row] : Segment{0, 0, 1};
                rows.set(row, l, s.front, s.back, s.through);
            }
        streams.insert(rows);
    }
    std::vector<std::vector<float>> texels(rays.size(), std::vector<float>(2 * nodes));
    for (std::size_t l = 0; l < rays.size(); ++l) streams.store(l, texels[l].data());
    return texels;
}

// Overlapping media and surfaces: some at whole depths, some opaque, some clear.
Segments ordinary(base::Random& random) {
    Segments segments = testing::random_segments(random.bits(), 10 + static_cast<int>(random.below(50)), 1, 90);
    const bool faint = random.uniform() < 0.5, walls = random.uniform() < 0.3;
    for (Segment& s : segments) {
        if (random.uniform() < 0.3) s.back = s.front;
        if (random.uniform() < 0.4) s.front = std::floor(s.front);
        if (random.uniform() < 0.4) s.back = std::max(s.front, std::floor(s.back));
        if (faint) s.through = 0.9f + 0.1f * s.through;
        if (random.uniform() < 0.1) s.through = 1.0f;
        if (walls && random.uniform() < 0.05) s.through = 0.0f;
    }
    return segments;
}

// Steps of one height at even distances: nearly all areas are equal, in every digit.
Segments even_steps(base::Random& random) {
    Segments segments;
    const bool media = random.uniform() < 0.5;
    for (int i = 0; i < 40; ++i) {
        const auto front = static_cast<float>(2 * i + 1);
        segments.push_back(
            {front, media ? front + 1.0f : front, static_cast<float>(63 - i) / static_cast<float>(64 - i)});
    }
    return segments;
}

// Few depths, with many segments at each: neighbouring floats, denormals, 1e30, every kind of transmittance.
Segments hostile(base::Random& random) {
    Segments segments;
    const bool media = random.uniform() < 0.7;
    for (std::uint64_t i = random.below(40); i > 0; --i) {
        const auto draw = [&](std::uint64_t n) { return static_cast<int>(random.below(n)); };
        segments.push_back(testing::segment_of({0, draw(18), draw(6), draw(13)}, {.media = media}));
    }
    return segments;
}

template <int nodes>
void compare_lanes() {
    for (const auto& [make, far_plane] :
         {std::pair{&ordinary, 100.0f}, std::pair{&even_steps, 100.0f}, std::pair{&hostile, 1e32f}})
        for (int seed = 0; seed < 40; ++seed) {
            base::Random random(base::hash(nodes, seed));
            std::vector<Segments> rays(stream_lanes);
            std::vector<std::vector<float>> expected;
            for (std::size_t l = 0; l < stream_lanes; ++l) {
                rays[l] = make(random);
                if (l % 2 == 0)
                    shuffle(rays[l], random);
                else
                    std::sort(rays[l].begin(), rays[l].end(), [](const Segment& a, const Segment& b) {
                        return std::tie(a.front, a.back) < std::tie(b.front, b.back);
                    });
                expected.push_back(streamed<nodes>(rays[l], far_plane));
            }
            for (const base::SimdPath path : base::simd_paths()) {
                const OnPath on(path);
                const auto found = side_by_side<nodes>(rays, far_plane, 1 + static_cast<std::size_t>(seed) % 16);
                for (std::size_t l = 0; l < stream_lanes; ++l)
                    ASSERT_EQ(found[l], expected[l]) << "path " << static_cast<int>(path) << ", lane " << l << ", seed "
                                                     << seed << ", " << far_plane;
            }
        }
}

// Otherwise a texel would depend on the machine, on the texels beside it, or on how many nodes it has.
TEST(AvsmLanes, HaveTheBitsOfOneStreamOnEveryPath) {
    compare_lanes<4>();
    compare_lanes<8>();
    compare_lanes<16>();
}

// The places behind the last node look like nodes at the far plane, but what is there counts.
TEST(AvsmLanes, SegmentsThatTouchTheFarPlaneAreFeltBehindIt) {
    const std::vector<Segments> rays(stream_lanes, {{3, 3, 0.5f}, {3, 3, 0.5f}, {1, 3, 0.25f}, {3, 3, 0.5f}});
    for (const base::SimdPath path : base::simd_paths()) {
        const OnPath on(path);
        for (const std::vector<float>& texel : side_by_side<8>(rays, 3.0f, 1)) {
            EXPECT_EQ(texel[7], 3.0f);
            EXPECT_EQ(texel[15], 0.03125f);
        }
    }
}

std::vector<std::uint32_t> order_of(std::uint64_t key, std::uint32_t count) {
    Shuffle shuffle;
    shuffle.begin(key, count);
    std::vector<std::uint32_t> result(count);
    for (std::uint32_t k = 0; k < count; k += Shuffle::most_entries)
        shuffle.entries(k, std::span(result).subspan(k, std::min<std::size_t>(count - k, Shuffle::most_entries)));
    return result;
}

// Entry by entry. Shuffled maps would change with any other permutation.
std::uint32_t feistel(std::uint64_t key, std::uint32_t count, std::uint32_t entry) {
    const int half = (std::bit_width(count > 1 ? count - 1 : 1u) + 1) / 2;
    const std::uint64_t mask = (std::uint64_t{1} << half) - 1;
    std::uint64_t at = entry;
    do {
        std::uint64_t left = at >> half, right = at & mask;
        for (std::uint64_t round = 0; round < 8; ++round)
            left = std::exchange(right, left ^ (base::hash(key, round, right) & mask));
        at = left << half | right;
    } while (at >= count);
    return static_cast<std::uint32_t>(at);
}

TEST(AvsmShuffle, IsAPermutationOfEveryLength) {
    std::vector<std::uint32_t> counts(300);
    std::iota(counts.begin(), counts.end(), 1u);
    counts.push_back(70'000);  // too long for a table
    for (const std::uint32_t count : counts) {
        std::vector<int> met(count, 0);
        const std::vector<std::uint32_t> order = order_of(count, count);
        for (std::uint32_t k = 0; k < count; ++k) {
            ASSERT_LT(order[k], count);
            ++met[order[k]];
            if (k < 1000) {
                ASSERT_EQ(order[k], feistel(count, count, k));
            }
        }
        EXPECT_THAT(met, ::testing::Each(1)) << count;
    }
}

TEST(AvsmShuffle, PutsEveryEntryAnywhere) {
    constexpr std::uint32_t count = 5;
    int met[count][count] = {};
    for (std::uint64_t key = 0; key < 5000; ++key) {
        const std::vector<std::uint32_t> order = order_of(base::mix(key), count);
        for (std::uint32_t k = 0; k < count; ++k) ++met[k][order[k]];
    }
    for (const auto& row : met)
        for (const int times : row) EXPECT_NEAR(times, 1000, 150);
}

// Otherwise a texel would get segments of the ray that its lane held before, or another order once a ray has more
// segments than are shuffled at once.
TEST(AvsmFilling, GivesEachTexelTheSegmentsOfItsRayInTheirOrder) {
    constexpr int nodes = 8;
    constexpr std::size_t count = 40;
    constexpr float far_plane = 100.0f;
    testing::HandRays given;
    given.width = static_cast<int>(count);
    for (std::size_t r = 0; r < count; ++r)
        given.rays.push_back(testing::random_segments(base::hash(7, r), static_cast<int>(1 + r * r / 8), 1, 90));
    const rays::LightRays rays = testing::light_rays(given);
    for (const Order way : {Order::sorted, Order::captured, Order::shuffled}) {
        std::vector<std::vector<float>> texels(count, std::vector<float>(2 * nodes));
        Filling<nodes> filling(rays, way, far_plane);
        for (std::size_t r = 0; r < count; ++r) filling.add(texels[r].data(), r, base::hash(1, r));
        filling.finish();
        for (std::size_t r = 0; r < count; ++r) {
            const std::uint32_t begin = rays.begin[r];
            const std::vector<std::uint32_t> shuffled = order_of(base::hash(1, r), rays.begin[r + 1] - begin);
            Segments segments;
            for (std::uint32_t k = 0; k < shuffled.size(); ++k) {
                const std::uint32_t s = way == Order::sorted     ? begin + k
                                        : way == Order::captured ? rays.submission[begin + k]
                                                                 : begin + shuffled[k];
                segments.push_back({rays.z_front[s], rays.back(s), rays.transmittance[s]});
            }
            EXPECT_EQ(texels[r], streamed<nodes>(segments, far_plane))
                << "order " << static_cast<int>(way) << ", ray " << r;
        }
    }
}

}  // namespace
}  // namespace shadowbench::techniques
