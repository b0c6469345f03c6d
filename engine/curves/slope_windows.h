// The lines from one point that pass within a tolerance of many vertices, four vertices at a time.
#pragma once

#include <algorithm>
#include <cstddef>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "curves/curve.h"

namespace shadowbench::curves {

// The least and the greatest slope.
struct Slopes {
    double low, high;
};

// Narrows the slopes of lines from (z, value) by blocks of four vertices, and returns how many vertices that were: the
// first block that starts at `first` and each next one, for as long as some line is left and the block ends where its
// depth ends. The slopes come out as if the vertices had narrowed them one by one, to the bit: the greatest and the
// least number do not depend on the order. Inputs that are not visibility functions give some slopes. Without SSE2
// there are no blocks.
inline std::size_t narrow_by_blocks(CurveView curve, std::size_t first, double z, double value, double epsilon,
                                    Slopes& slopes) {
#if defined(__SSE2__)
    static_assert(sizeof(Vertex) == 2 * sizeof(float), "a block is read as pairs of depth and value");
    const __m128d origin = _mm_set1_pd(z), from = _mm_set1_pd(value), within = _mm_set1_pd(epsilon);
    __m128d low = _mm_set1_pd(slopes.low), high = _mm_set1_pd(slopes.high);
    std::size_t next = first;
    for (; next + 4 <= curve.size(); next += 4) {
        const Vertex* vertices = curve.data() + next;
        if (next + 4 < curve.size() && vertices[4].z == vertices[3].z) break;
        const __m128 a = _mm_loadu_ps(&vertices[0].z), b = _mm_loadu_ps(&vertices[2].z);
        const __m128 depths = _mm_shuffle_ps(a, b, _MM_SHUFFLE(2, 0, 2, 0));
        const __m128 values = _mm_shuffle_ps(a, b, _MM_SHUFFLE(3, 1, 3, 1));
        __m128d lower = low, upper = high;
        const auto pass = [&](__m128 depth_pair, __m128 value_pair) {
            const __m128d inverse = _mm_div_pd(_mm_set1_pd(1.0), _mm_sub_pd(_mm_cvtps_pd(depth_pair), origin));
            const __m128d at = _mm_cvtps_pd(value_pair);
            const __m128d floor = _mm_max_pd(_mm_sub_pd(at, within), _mm_setzero_pd());
            const __m128d ceiling = _mm_add_pd(at, within);
            lower = _mm_max_pd(_mm_mul_pd(_mm_sub_pd(floor, from), inverse), lower);
            upper = _mm_min_pd(_mm_mul_pd(_mm_sub_pd(ceiling, from), inverse), upper);
        };
        pass(depths, values);
        pass(_mm_movehl_ps(depths, depths), _mm_movehl_ps(values, values));
        const __m128d least = _mm_min_pd(upper, _mm_shuffle_pd(upper, upper, 1));
        if (_mm_movemask_pd(_mm_cmple_pd(lower, least)) != 3) break;
        low = lower;
        high = upper;
    }
    slopes.low = std::max(_mm_cvtsd_f64(low), _mm_cvtsd_f64(_mm_unpackhi_pd(low, low)));
    slopes.high = std::min(_mm_cvtsd_f64(high), _mm_cvtsd_f64(_mm_unpackhi_pd(high, high)));
    return next - first;
#else
    static_cast<void>(curve), static_cast<void>(first), static_cast<void>(z), static_cast<void>(value);
    static_cast<void>(epsilon), static_cast<void>(slopes);
    return 0;
#endif
}

}  // namespace shadowbench::curves
