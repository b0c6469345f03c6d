#include "techniques/deep/segments.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "techniques/store/before.h"
#include "techniques/store/simd_path.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace shadowbench::techniques {
namespace {

constexpr std::uint32_t lanes = 16;  // depths that are compared at once
constexpr std::size_t floats_a_line = 16;

void load_ranges(const DeepLevel& map, std::size_t count, Segments& s) {
    const std::uint32_t* const offsets = map.offsets.data();
    const float* const floats = map.floats.data();
    for (std::size_t r = 0; r < count; ++r) {
        std::memcpy(&s.range[r], offsets + s.pixel[r], sizeof(Segments::Range));
        const float* const first = floats + s.range[r].begin;
        __builtin_prefetch(first);
        __builtin_prefetch(first + floats_a_line);
    }
}

// What is left of the nodes of a read: at most `lanes`, from the first one on.
struct Few {
    const float* depths;
    std::uint32_t nodes;
};

// Almost without branches: those of a search are hard to predict.
[[gnu::always_inline]] inline Few narrow(const float* depths, std::uint32_t nodes, float z) {
    while (nodes > lanes) {  // most functions are shorter
        const std::uint32_t half = nodes / 2;
        depths += half & -static_cast<std::uint32_t>(depths[half - 1] < z);
        nodes -= half;
    }
    return {depths, nodes};
}

// `before`: bit i says whether depth i of `few` is before z.
[[gnu::always_inline]] inline void set_segment(const float* depths, std::uint32_t nodes, const Few& few,
                                               std::uint32_t before, std::size_t r, Segments& s) {
    const std::uint32_t known = before & ((1u << few.nodes) - 1) & ~1u;  // without the first: see Segments::left
    const auto more = static_cast<std::uint32_t>(std::popcount(known));
    const auto at = static_cast<std::uint32_t>(few.depths - depths) + more;
    s.left[r] = at;
    std::memcpy(&s.depths[r], depths + at, sizeof(Segments::Two));
    std::memcpy(&s.values[r], depths + nodes + at, sizeof(Segments::Two));
}

void search(const DeepLevel& map, std::size_t slots, Segments& s) {
    const float* const floats = map.floats.data();
    for (std::size_t r = 0; r < slots * block_queries; ++r) {
        const float z = s.z[r % block_queries];
        const float* depths = floats + s.range[r].begin;
        const std::uint32_t nodes = (s.range[r].end - s.range[r].begin) / 2;
        const Few few = narrow(depths, nodes, z);
        std::uint32_t before = 0;
        if (static_cast<std::size_t>(few.depths - floats) + lanes <= map.floats.size()) {
            before = depths_before<lanes>(few.depths, z);
        } else {  // the last functions of the map may be nearer to its end than a vector is long
            for (std::uint32_t i = 0; i < few.nodes; ++i) before |= static_cast<std::uint32_t>(few.depths[i] < z) << i;
        }
        set_segment(depths, nodes, few, before, r, s);
    }
}

#if defined(__x86_64__)
[[gnu::target("avx512f,avx512vl,avx512dq,avx512bw,bmi2,popcnt")]] void search_avx512(const DeepLevel& map, std::size_t slots,
                                                                       Segments& s) {
    const float* const floats = map.floats.data();
    for (std::size_t k = 0; k < block_queries; ++k) {
        const float z = s.z[k];
        const __m512 limit = _mm512_set1_ps(z);
        for (std::size_t r = k; r < slots * block_queries; r += block_queries) {
            const float* depths = floats + s.range[r].begin;
            const std::uint32_t nodes = (s.range[r].end - s.range[r].begin) / 2;
            const Few few = narrow(depths, nodes, z);
            const auto mask = static_cast<__mmask16>((1u << few.nodes) - 1);
            const std::uint32_t before =
                _mm512_mask_cmp_ps_mask(mask, _mm512_maskz_loadu_ps(mask, few.depths), limit, _CMP_LT_OQ);
            set_segment(depths, nodes, few, before, r, s);
        }
    }
}
#endif

// The values of all reads, with the bits of curves::evaluate. In two loops: compilers turn one into branches.
SHADOWBENCH_SIMD_LOOP inline void join(const Segments& s, std::size_t slots, float* __restrict values) {
    for (std::size_t slot = 0; slot < slots; ++slot)
        for (std::size_t k = 0; k < block_queries; ++k) {
            const std::size_t r = slot * block_queries + k;
            const double z = s.z[k], left = s.depths[r].left, right = s.depths[r].right;
            const double from = s.values[r].left, to = s.values[r].right;
            values[r] = static_cast<float>(from + (to - from) * ((z - left) / (right - left)));
        }
    for (std::size_t slot = 0; slot < slots; ++slot)
        for (std::size_t k = 0; k < block_queries; ++k) {
            const std::size_t r = slot * block_queries + k;
            const std::uint32_t nodes = (s.range[r].end - s.range[r].begin) / 2, next = s.left[r] + 1;
            const float z = s.z[k], left_z = s.depths[r].left, right_z = s.depths[r].right;
            const float left = s.values[r].left, right = s.values[r].right, joined = values[r];
            float value = z == right_z ? right : joined;
            value = next == nodes ? left : value;
            value = left_z < z ? value : left;
            values[r] = nodes == 0 ? 1.0f : value;
        }
}

}  // namespace

void find_segments(const DeepLevel& map, std::size_t slots, Segments& segments) {
    load_ranges(map, slots * block_queries, segments);
#if defined(__x86_64__)
    if (simd_path() == SimdPath::avx512) return search_avx512(map, slots, segments);
#endif
    search(map, slots, segments);
}

void mean_of_four(const Segments& segments, const double* weights, float* means) {
    on_simd_path([&s = segments, weights, means]() SHADOWBENCH_SIMD_LOOP {
        alignas(64) std::array<float, Segments::most> values;
        join(s, cell_slots, values.data());
        const double* __restrict weight = weights;
        float* __restrict out = means;
        for (std::size_t k = 0; k < block_queries; ++k) {
            double sum = 0.0, total = 0.0;
            for (std::size_t slot = 0; slot < cell_slots; ++slot) {
                const double w = weight[slot * block_queries + k];
                sum += w * values[slot * block_queries + k];
                total += w;
            }
            out[k] = std::min(static_cast<float>(sum / total), 1.0f);
        }
    });
}

void value_of_one(const Segments& segments, float* values) {
    on_simd_path([&s = segments, values]() SHADOWBENCH_SIMD_LOOP { join(s, 1, values); });
}

}  // namespace shadowbench::techniques
