// Finds the nodes around a depth.
#pragma once

#include <bit>
#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace shadowbench::techniques {

// Bit i: whether depth i of the first `count` sorted depths is before z; count is a multiple of 4, at most 28. They are
// the first ones. A NaN has none before it.
template <int count>
[[gnu::always_inline]] inline std::uint32_t depths_before(const float* depths, float z) {
    static_assert(count % 4 == 0 && count <= 28);
    std::uint32_t before = 0;
#if defined(__SSE2__)
    const __m128 limit = _mm_set1_ps(z);
    for (int i = 0; i < count; i += 4)
        before |= static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmplt_ps(_mm_loadu_ps(depths + i), limit))) << i;
#else
    for (int i = 0; i < count; ++i) before |= static_cast<std::uint32_t>(depths[i] < z) << i;
#endif
    return before;
}

// The nodes on both sides of a depth. Before the first node and behind the last one both are the same.
struct Sides {
    int left, right;
};

// The sides for these bits. Without branches, which would often be mispredicted.
template <int count>
[[gnu::always_inline]] inline Sides sides(std::uint32_t before) {
    constexpr std::uint32_t all = (1u << count) - 1;
    return {31 - std::countl_zero(before | 1u), 31 - std::countl_zero(((before << 1) | 1u) & all)};
}

}  // namespace shadowbench::techniques
