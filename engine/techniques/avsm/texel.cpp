#include "techniques/avsm/texel.h"

namespace shadowbench::techniques {
namespace {

template <Sampling sampling>
inline float between(const float* texel, int nodes, int next, float z) {
    const float* values = texel + nodes;
    if (next == 0) return values[0];
    if (next == nodes) return values[nodes - 1];
    return join_nodes<sampling>({texel[next - 1], values[next - 1]}, {texel[next], values[next]}, z);
}

// Counting the depths before z needs no branch and, for a fixed number, becomes a few vector comparisons.
template <Sampling sampling, int fixed>
float evaluate_fixed(const float* texel, int, float z) {
    int next = 0;
    for (int i = 0; i < fixed; ++i) next += texel[i] < z;
    return between<sampling>(texel, fixed, next, z);
}

template <Sampling sampling>
float evaluate_any(const float* texel, int nodes, float z) {
    int next = 0;
    for (int i = 0; i < nodes; ++i) next += texel[i] < z;
    return between<sampling>(texel, nodes, next, z);
}

template <Sampling sampling>
TexelEvaluator evaluator(int nodes) {
    switch (nodes) {
        case 4:
            return evaluate_fixed<sampling, 4>;
        case 8:
            return evaluate_fixed<sampling, 8>;
        case 12:
            return evaluate_fixed<sampling, 12>;
        case 16:
            return evaluate_fixed<sampling, 16>;
        default:
            return evaluate_any<sampling>;
    }
}

}  // namespace

TexelEvaluator texel_evaluator(int nodes, Sampling sampling) {
    return sampling == Sampling::linear ? evaluator<Sampling::linear>(nodes) : evaluator<Sampling::exponential>(nodes);
}

}  // namespace shadowbench::techniques
