// The segments of many texels inserted side by side, against the algorithm node by node; and their random order.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "base/random.h"
#include "techniques/avsm/filling.h"
#include "techniques/avsm/order.h"
#include "techniques/avsm/streams.h"
#include "techniques/avsm_nodes.h"
#include "techniques/store/simd_path.h"

namespace shadowbench::techniques {
namespace {

using testing::Nodes;
using testing::nodes_of;
using testing::Segment;
using testing::shuffle;

constexpr float far_plane = 100.0f;

// The algorithm node by node, as section 3.2 has it.
class Plain {
public:
    Plain(int capacity, float far_depth, Sampling sampling)
        : capacity_(static_cast<std::size_t>(capacity)), sampling_(sampling), nodes_{{far_depth, 1.0f}} {}

    void insert(const Segment& s) {
        if (s.through >= 1.0f) return;
        const auto not_before = [&](float z) {
            return std::find_if(nodes_.begin(), nodes_.end(), [&](const auto& node) { return node.first >= z; });
        };
        const auto behind =
            std::find_if(nodes_.begin(), nodes_.end(), [&](const auto& n) { return n.first > s.front; });
        const float before = value_at(not_before(s.front), s.front);
        const float after = value_at(not_before(s.back), s.back) * s.through;
        if (before <= 0.0f || (behind != nodes_.begin() && (behind - 1)->second <= 0.0f)) return;  // no light is left
        bool has_front = false, has_back = false;
        const float log_through = std::log(std::max(s.through, std::numeric_limits<float>::min()));
        for (auto& [z, value] : nodes_) {
            if (z == s.front && !has_front) {
                has_front = true;  // the value before the segment
                has_back = false;
            } else if (z == s.back) {
                has_back = true;
                value *= s.through;
            } else if (z > s.back) {
                value *= s.through;
            } else if (z > s.front) {
                value *= std::max(std::exp(log_through * ((z - s.front) / (s.back - s.front))), s.through);
            }
        }
        if (!has_back)
            nodes_.insert(std::find_if(nodes_.begin(), nodes_.end(), [&](const auto& n) { return n.first > s.back; }),
                          {s.back, after});
        if (!has_front) nodes_.insert(not_before(s.front), {s.front, before});
        while (nodes_.size() > capacity_) remove();
    }
    const Nodes& nodes() const { return nodes_; }

private:
    float value_at(Nodes::const_iterator node, float z) const {
        if (node == nodes_.begin()) return 1.0f;
        if (node->first == z) return node->second;
        const auto left = node - 1;
        const float share = (z - left->first) / (node->first - left->first);
        if (sampling_ == Sampling::exponential) return decay(left->second, node->second, share);
        return std::clamp(left->second + share * (node->second - left->second), node->second, left->second);
    }
    void remove() {
        std::size_t least = 0;
        float least_area = std::numeric_limits<float>::infinity();
        for (std::size_t i = 1; i + 1 < nodes_.size(); ++i) {
            const auto [z0, v0] = nodes_[i - 1];
            const auto [z1, v1] = nodes_[i];
            const auto [z2, v2] = nodes_[i + 1];
            // Without its last four bits: nearly equal areas are equal.
            const float area = std::bit_cast<float>(
                std::bit_cast<std::uint32_t>(std::abs((z2 - z0) * (v2 - v1) - (z2 - z1) * (v2 - v0))) & ~15u);
            if (area < least_area) {
                least = i;
                least_area = area;
            }
        }
        nodes_.erase(nodes_.begin() + static_cast<std::ptrdiff_t>(least));
    }

    std::size_t capacity_;
    Sampling sampling_;
    Nodes nodes_;
};

// Otherwise a texel would depend on the machine, or on the texels beside it.
TEST(AvsmStream, AllLanesAndPathsHaveTheNodesOfThePlainAlgorithm) {
    constexpr std::size_t rows = 70;
    for (const Sampling sampling : {Sampling::linear, Sampling::exponential})
        for (const int capacity : {2, 3, 4, 7, 8, 13, 16, 24, 64}) {
            std::vector<std::vector<Segment>> rays(lanes);
            std::vector<Plain> expected;
            for (std::size_t l = 0; l < lanes; ++l) {
                base::Random random(base::hash(capacity, l));
                rays[l] = testing::random_segments(base::hash(capacity, l), rows, 1, 90);
                for (Segment& s : rays[l]) {  // surfaces, equal depths, segments that meet, walls, nothing
                    if (random.uniform() < 0.3) s.back = s.front;
                    if (random.uniform() < 0.3) s.front = std::floor(s.front);
                    if (random.uniform() < 0.3) s.back = std::max(s.front, std::floor(s.back));
                    s.through = random.uniform() < 0.1 ? 1.0f : std::max(s.through, l % 2 == 0 ? 0.9f : 0.0f);
                    if (l == 3 && random.uniform() < 0.05) s.through = 0.0f;
                }
                if (l % 4 != 0) shuffle(rays[l], random);
                expected.emplace_back(capacity, far_plane, sampling);
                for (const Segment& s : rays[l]) expected.back().insert(s);
            }
            for (const SimdPath path : simd_paths()) {
                set_simd_path(path);
                Streams streams;
                for (std::size_t l = 0; l < lanes; ++l) streams.clear(l, capacity, far_plane);
                for (std::size_t first = 0; first < rows; first += 7) {
                    SegmentRows segments;
                    segments.count = 7;
                    for (std::size_t row = 0; row < 7; ++row)
                        for (std::size_t l = 0; l < lanes; ++l) {
                            const Segment& s = rays[l][first + row];
                            segments.set(row, l, s.front, s.back, s.through);
                        }
                    inserter(capacity)(streams, segments, capacity, sampling);
                }
                for (std::size_t l = 0; l < lanes; ++l)
                    EXPECT_EQ(nodes_of(streams, l, capacity), expected[l].nodes())
                        << "path " << static_cast<int>(path) << ", nodes " << capacity << ", lane " << l;
            }
            set_simd_path(simd_paths().back());
        }
}

std::vector<std::uint32_t> order(std::uint64_t key, std::uint32_t count) {
    Shuffle shuffle;
    shuffle.begin(key, count);
    std::vector<std::uint32_t> result(count);
    for (std::uint32_t k = 0; k < count; k += Shuffle::most_entries)
        shuffle.entries(k, std::span(result).subspan(k, std::min<std::size_t>(count - k, Shuffle::most_entries)));
    return result;
}

TEST(AvsmShuffle, IsAPermutationOfEveryLength) {
    std::vector<std::uint32_t> counts(300);
    std::iota(counts.begin(), counts.end(), 1u);
    counts.push_back(70'000);  // longer than what a shuffle keeps
    for (const std::uint32_t count : counts) {
        std::vector<int> met(count, 0);
        for (const std::uint32_t k : order(count, count)) {
            ASSERT_LT(k, count);
            ++met[k];
        }
        EXPECT_THAT(met, ::testing::Each(1)) << count;
    }
}

TEST(AvsmShuffle, PutsEveryEntryAnywhere) {
    constexpr std::uint32_t count = 5;
    int met[count][count] = {};
    for (std::uint64_t key = 0; key < 5000; ++key) {
        const std::vector<std::uint32_t> entries = order(base::mix(key), count);
        for (std::uint32_t k = 0; k < count; ++k) ++met[k][entries[k]];
    }
    for (const auto& row : met)
        for (const int times : row) EXPECT_NEAR(times, 1000, 150);
}

// Otherwise a texel would get segments of the ray that its lane held before, or another order once a ray has more
// segments than are shuffled at once.
TEST(AvsmFilling, GivesEachTexelTheSegmentsOfItsRayInTheirOrder) {
    constexpr int capacity = 8;
    constexpr std::size_t count = 40;
    testing::HandRays given;
    given.width = static_cast<int>(count);
    for (std::size_t r = 0; r < count; ++r)
        given.rays.push_back(testing::random_segments(base::hash(7, r), static_cast<int>(1 + r * r / 8), 1, 90));
    const rays::LightRays rays = testing::light_rays(given);
    for (const Order way : {Order::sorted, Order::captured, Order::shuffled}) {
        std::vector<float> texels(2 * capacity * count);
        Filling filling(rays, capacity, Sampling::linear, way, far_plane);
        for (std::size_t r = 0; r < count; ++r) filling.add(&texels[2 * capacity * r], r, base::hash(1, r));
        filling.finish();
        for (std::size_t r = 0; r < count; ++r) {
            const std::uint32_t begin = rays.begin[r];
            const std::vector<std::uint32_t> shuffled = order(base::hash(1, r), rays.begin[r + 1] - begin);
            Plain expected(capacity, far_plane, Sampling::linear);
            for (std::uint32_t k = 0; k < shuffled.size(); ++k) {
                const std::uint32_t s = way == Order::sorted     ? begin + k
                                        : way == Order::captured ? rays.submission[begin + k]
                                                                 : begin + shuffled[k];
                expected.insert({rays.z_front[s], rays.back(s), rays.transmittance[s]});
            }
            const float* texel = &texels[2 * capacity * r];
            Nodes found;
            for (int i = 0; i < capacity && (i == 0 || texel[i - 1] != far_plane); ++i)
                found.emplace_back(texel[i], texel[capacity + i]);
            EXPECT_EQ(found, expected.nodes()) << "order " << static_cast<int>(way) << ", ray " << r;
        }
    }
}

}  // namespace
}  // namespace shadowbench::techniques
