#include "techniques/deep/segments.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>
#include <cstdlib>

#include "techniques/store/before.h"
#include "techniques/store/simd_path.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace shadowbench::techniques {
namespace {

constexpr std::uint32_t lanes = 16;  // depths that are compared at once

using Numbers = std::array<std::uint8_t, Segments::most>;

// Sets the ranges and collects the numbers of the functions that have nodes. Returns how many.
std::size_t load_ranges(const DeepLevel& map, Segments& s, Numbers& lit) {
    const std::uint32_t* const offsets = map.offsets.data();
    std::size_t count = 0;
    for (std::size_t r = 0; r < s.slots * block_queries; ++r) {
        std::uint64_t both;
        static_assert(sizeof(both) == sizeof(Segments::Range));
        std::memcpy(&both, offsets + s.pixel[r], sizeof(both));
        std::memcpy(&s.range[r], &both, sizeof(both));
        lit[count] = static_cast<std::uint8_t>(r);
        count += static_cast<std::uint32_t>(both) != both >> 32 ? 1 : 0;  // both offsets are equal without nodes
    }
    return count;
}

void prefetch(const DeepLevel& map, std::span<const std::uint8_t> numbers, const Segments& s) {
    const float* const floats = map.floats.data();
    for (const std::uint8_t r : numbers) {
        __builtin_prefetch(floats + s.range[r].begin);
        __builtin_prefetch(floats + s.range[r].end - 1);
    }
}

// What is left of the nodes of a function: at most `lanes`. The segment does not begin before the first of them.
struct Few {
    const float* depths;
    std::uint32_t nodes;
};

// Almost without branches: those of a search are hard to predict.
[[gnu::always_inline]] inline Few narrow(const float* depths, std::uint32_t nodes, float z) {
    while (nodes > lanes) [[unlikely]] {
        const std::uint32_t half = nodes / 2;
        depths += half & -static_cast<std::uint32_t>(depths[half] < z);
        nodes -= half;
    }
    return {depths, nodes};
}

// Bits of lanes [1, n).
[[gnu::always_inline]] inline std::uint32_t lanes_behind_first(std::uint32_t n) {
    return ~1u & ((1u << n) - 1);
}

// `more`: the number of nodes of `few` before z, without the first.
[[gnu::always_inline]] inline void set_segment(const float* depths, std::uint32_t nodes, const Few& few,
                                               std::uint32_t more, std::size_t r, Segments& s) {
    const std::size_t at = static_cast<std::size_t>(few.depths - depths) + more;
    s.left[r] = static_cast<std::uint32_t>(at);
    std::memcpy(&s.depths[r], depths + at, sizeof(Segments::Two));
    std::memcpy(&s.values[r], depths + nodes + at, sizeof(Segments::Two));
}

[[gnu::always_inline]] inline std::uint32_t nodes_of(const Segments::Range& range) {
    return (range.end - range.begin) / 2;
}

void search(const DeepLevel& map, std::span<const std::uint8_t> numbers, Segments& s) {
    const float* const floats = map.floats.data();
    for (const std::uint8_t r : numbers) {
        const float z = s.z[r % block_queries];
        const float* const depths = floats + s.range[r].begin;
        const std::uint32_t nodes = nodes_of(s.range[r]);
        const Few few = narrow(depths, nodes, z);
        std::uint32_t before = 0;
        if (static_cast<std::size_t>(few.depths - floats) + lanes <= map.floats.size()) {
            before = depths_before<lanes>(few.depths, z);
        } else {  // the last functions of the map may be nearer to its end than a vector is long
            for (std::uint32_t i = 0; i < few.nodes; ++i) before |= static_cast<std::uint32_t>(few.depths[i] < z) << i;
        }
        before &= lanes_behind_first(few.nodes);
        set_segment(depths, nodes, few, 31 - static_cast<std::uint32_t>(std::countl_zero(before | 1)), r, s);
    }
}

#if defined(__x86_64__)
[[gnu::target("avx512f,avx512vl,avx512dq,avx512bw,bmi2,popcnt")]] void search_avx512(
    const DeepLevel& map, std::span<const std::uint8_t> numbers, Segments& s) {
    const float* const floats = map.floats.data();
    for (const std::uint8_t r : numbers) {
        const float z = s.z[r % block_queries];
        const float* const depths = floats + s.range[r].begin;
        const std::uint32_t nodes = nodes_of(s.range[r]);
        const Few few = narrow(depths, nodes, z);
        const auto mask = static_cast<__mmask16>(lanes_behind_first(few.nodes));
        const std::uint32_t before =
            _mm512_mask_cmp_ps_mask(mask, _mm512_maskz_loadu_ps(mask, few.depths), _mm512_set1_ps(z), _CMP_LT_OQ);
        set_segment(depths, nodes, few, static_cast<std::uint32_t>(std::popcount(before)), r, s);
    }
}
#endif

// The values of all reads, with the bits of curves::evaluate. In two loops: compilers turn one into branches.
SHADOWBENCH_SIMD_LOOP inline void join(const Segments& s, float* __restrict values) {
    for (std::size_t slot = 0; slot < s.slots; ++slot)
        for (std::size_t k = 0; k < block_queries; ++k) {
            const std::size_t r = slot * block_queries + k;
            const double z = s.z[k], left = s.depths[r].left, right = s.depths[r].right;
            const double from = s.values[r].left, to = s.values[r].right;
            values[r] = static_cast<float>(from + (to - from) * ((z - left) / (right - left)));
        }
    for (std::size_t slot = 0; slot < s.slots; ++slot)
        for (std::size_t k = 0; k < block_queries; ++k) {
            const std::size_t r = slot * block_queries + k;
            const std::uint32_t nodes = nodes_of(s.range[r]), next = s.left[r] + 1;
            const float z = s.z[k], left_z = s.depths[r].left, right_z = s.depths[r].right;
            const float left = s.values[r].left, right = s.values[r].right, joined = values[r];
            float value = z == right_z ? right : joined;
            value = next == nodes ? left : value;
            value = left_z < z ? value : left;
            values[r] = nodes == 0 ? 1.0f : value;
        }
}

template <std::size_t slots>
SHADOWBENCH_SIMD_LOOP inline void average(const float* values, const double* __restrict weight, float* __restrict out) {
    for (std::size_t k = 0; k < block_queries; ++k) {
        double sum = 0.0, total = 0.0;
        for (std::size_t slot = 0; slot < slots; ++slot) {
            const double w = weight[slot * block_queries + k];
            sum += w * values[slot * block_queries + k];
            total += w;
        }
        out[k] = std::min(static_cast<float>(sum / total), 1.0f);
    }
}

}  // namespace

void find_segments(const DeepLevel& map, Segments& segments) {
    Numbers numbers;
    const std::span<const std::uint8_t> lit = std::span(numbers).first(load_ranges(map, segments, numbers));
    static const bool pf=getenv("PF");
    if (pf) prefetch(map, lit, segments);
#if defined(__x86_64__)
    if (simd_path() == SimdPath::avx512) return search_avx512(map, lit, segments);
#endif
    search(map, lit, segments);
}

void mean_of(const Segments& segments, const double* weights, float* means) {
    on_simd_path([&s = segments, weights, means]() SHADOWBENCH_SIMD_LOOP {
        if (s.slots == 1) return join(s, means);
        alignas(64) std::array<float, Segments::most> values;
        join(s, values.data());
        s.slots == 2 ? average<2>(values.data(), weights, means) : average<4>(values.data(), weights, means);
    });
}

}  // namespace shadowbench::techniques
