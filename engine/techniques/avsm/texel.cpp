#include "techniques/avsm/texel.h"

#include "curves/curve.h"

namespace shadowbench::techniques {
namespace {

inline float between(const float* texel, int nodes, int next, float z) {
    const float* values = texel + nodes;
    if (next == 0) return values[0];
    if (next == nodes) return values[nodes - 1];
    return curves::join({texel[next - 1], values[next - 1]}, {texel[next], values[next]}, z);
}

// Counting the depths before z needs no branch and, for a fixed number, becomes a few vector comparisons.
template <int fixed>
float evaluate_fixed(const float* texel, int, float z) {
    int next = 0;
    for (int i = 0; i < fixed; ++i) next += texel[i] < z;
    return between(texel, fixed, next, z);
}

float evaluate_any(const float* texel, int nodes, float z) {
    int next = 0;
    for (int i = 0; i < nodes; ++i) next += texel[i] < z;
    return between(texel, nodes, next, z);
}

}  // namespace

TexelEvaluator texel_evaluator(int nodes) {
    switch (nodes) {
        case 4:
            return evaluate_fixed<4>;
        case 8:
            return evaluate_fixed<8>;
        case 12:
            return evaluate_fixed<12>;
        case 16:
            return evaluate_fixed<16>;
        default:
            return evaluate_any;
    }
}

}  // namespace shadowbench::techniques
