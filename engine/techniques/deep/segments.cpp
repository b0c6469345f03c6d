#include "techniques/deep/segments.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>

#include "base/simd_path.h"
#include "techniques/store/before.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace shadowbench::techniques {
namespace {

constexpr std::uint32_t lanes = 16;  // depths that are compared at once

// The numbers of functions that have nodes. Those that need more than one comparison are kept apart: when both are
// mixed, the processor predicts badly which comes next.
struct Numbers {
    std::array<std::uint8_t, Segments::most> of;  // first the short ones, at the end the long ones
    std::size_t short_count = 0, long_count = 0;

    std::span<const std::uint8_t> short_ones() const { return std::span(of).first(short_count); }
    std::span<const std::uint8_t> long_ones() const { return std::span(of).last(long_count); }
};

// Sets the ranges. Without branches, like the searches: they would be hard to predict.
Numbers load_ranges(const DeepLevel& map, Segments& s) {
    constexpr std::uint32_t most_short = 2 * lanes;  // floats
    const std::uint32_t* const offsets = map.offsets.data();
    Numbers numbers;
    std::size_t short_count = 0, long_count = 0;
    for (std::size_t r = 0; r < s.slots * block_queries; ++r) {
        const std::uint32_t begin = offsets[s.pixel[r]], end = offsets[s.pixel[r] + 1];
        s.range[r] = {begin, end};
        const std::uint32_t floats = end - begin;
        numbers.of[short_count] = numbers.of[Segments::most - 1 - long_count] = static_cast<std::uint8_t>(r);
        short_count += floats - 1 < most_short ? 1 : 0;  // 0 - 1 is large
        long_count += floats > most_short ? 1 : 0;
    }
    numbers.short_count = short_count;
    numbers.long_count = long_count;
    return numbers;
}

// A smaller map stays in the caches nearest to the processor, and prefetching would take longer than it saves.
bool is_large(const DeepLevel& map) {
    return map.floats.size() > (std::size_t{1} << 17);
}

void prefetch(const DeepLevel& map, const Numbers& numbers, const Segments& s) {
    constexpr std::uint32_t floats_a_line = 16, most = 8 * floats_a_line;  // more would not arrive in time
    const float* const floats = map.floats.data();
    for (const std::uint8_t r : numbers.short_ones()) {
        __builtin_prefetch(floats + s.range[r].begin);
        __builtin_prefetch(floats + s.range[r].end - 1);
    }
    for (const std::uint8_t r : numbers.long_ones()) {
        const Segments::Range& range = s.range[r];
        const std::uint32_t end = std::min(range.end, range.begin + most);
        for (std::uint32_t i = range.begin; i < end; i += floats_a_line) __builtin_prefetch(floats + i);
        __builtin_prefetch(floats + end - 1);
    }
}

[[gnu::always_inline]] inline std::uint32_t nodes_of(const Segments::Range& range) {
    return (range.end - range.begin) / 2;
}

// A function, and at most `lanes` of its nodes, before whose first one the segment does not begin.
struct Few {
    const float *depths, *few;
    std::uint32_t nodes, few_nodes;

    template <bool is_short>
    [[gnu::always_inline]] static Few of(const float* floats, const Segments::Range& range, float z) {
        const float* const depths = floats + range.begin;
        Few f{depths, depths, nodes_of(range), nodes_of(range)};
        while (!is_short && f.few_nodes > lanes) {
            const std::uint32_t half = f.few_nodes / 2;
            f.few += half & -static_cast<std::uint32_t>(f.few[half] < z);
            f.few_nodes -= half;
        }
        return f;
    }
    // Bits of the lanes of the nodes, without the first.
    [[gnu::always_inline]] std::uint32_t lanes_behind_first() const { return ~1u & ((1u << few_nodes) - 1); }
    // `more`: how many of those are before z.
    [[gnu::always_inline]] void set_segment(std::uint32_t more, std::size_t r, Segments& s) const {
        const std::size_t at = static_cast<std::size_t>(few - depths) + more;
        s.left[r] = static_cast<std::uint32_t>(at);
        std::memcpy(&s.depths[r], depths + at, sizeof(Segments::Two));
        std::memcpy(&s.values[r], depths + nodes + at, sizeof(Segments::Two));
    }
};

template <bool is_short>
void search(const DeepLevel& map, std::span<const std::uint8_t> numbers, Segments& s) {
    const float* const floats = map.floats.data();
    for (const std::uint8_t r : numbers) {
        const float z = s.z[r % block_queries];
        const Few f = Few::of<is_short>(floats, s.range[r], z);
        std::uint32_t before = 0;
        if (static_cast<std::size_t>(f.few - floats) + lanes <= map.floats.size()) {
            before = depths_before<lanes>(f.few, z);
        } else {  // the last functions of the map may be nearer to its end than a vector is long
            for (std::uint32_t i = 0; i < f.few_nodes; ++i) before |= static_cast<std::uint32_t>(f.few[i] < z) << i;
        }
        // The depths before z are the first ones, so the last of their bits gives their number, without an instruction
        // that counts bits.
        const int last = 31 - std::countl_zero((before & f.lanes_behind_first()) | 1);
        f.set_segment(static_cast<std::uint32_t>(last), r, s);
    }
}

#if defined(__x86_64__)
template <bool is_short>
[[gnu::target("avx512f,avx512vl,avx512dq,avx512bw,bmi2,popcnt")]] void search_avx512(
    const DeepLevel& map, std::span<const std::uint8_t> numbers, Segments& s) {
    const float* const floats = map.floats.data();
    for (const std::uint8_t r : numbers) {
        const float z = s.z[r % block_queries];
        const Few f = Few::of<is_short>(floats, s.range[r], z);
        const auto mask = static_cast<__mmask16>(f.lanes_behind_first());
        const std::uint32_t before =
            _mm512_mask_cmp_ps_mask(mask, _mm512_maskz_loadu_ps(mask, f.few), _mm512_set1_ps(z), _CMP_LT_OQ);
        f.set_segment(static_cast<std::uint32_t>(std::popcount(before)), r, s);
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
    const Numbers numbers = load_ranges(map, segments);
    if (is_large(map)) prefetch(map, numbers, segments);
#if defined(__x86_64__)
    if (base::simd_path() == base::SimdPath::avx512) {
        search_avx512<true>(map, numbers.short_ones(), segments);
        return search_avx512<false>(map, numbers.long_ones(), segments);
    }
#endif
    search<true>(map, numbers.short_ones(), segments);
    search<false>(map, numbers.long_ones(), segments);
}

void mean_of(const Segments& segments, const double* weights, float* means) {
    base::on_simd_path([&s = segments, weights, means]() SHADOWBENCH_SIMD_LOOP {
        alignas(64) std::array<float, Segments::most> values;
        join(s, values.data());
        if (s.slots == 1)  // needs no weights
            for (std::size_t k = 0; k < block_queries; ++k) means[k] = std::min(values[k], 1.0f);
        else if (s.slots == 2)
            average<2>(values.data(), weights, means);
        else
            average<4>(values.data(), weights, means);
    });
}

}  // namespace shadowbench::techniques
