#include "techniques/avsm/texel.h"

#include <algorithm>

#include "techniques/store/before.h"
#include "techniques/store/joins.h"

namespace shadowbench::techniques {
namespace {

// The nodes around z, of `fixed` or, if that is 0, of `nodes`.
template <int fixed>
[[gnu::always_inline]] inline Sides around(const float* texel, int nodes, float z) {
    if constexpr (fixed > 0) return sides<fixed>(depths_before<fixed>(texel, z));
    int count = 0;
    for (int i = 0; i < nodes; ++i) count += texel[i] < z;
    return {std::max(count - 1, 0), std::min(count, nodes - 1)};
}

template <Sampling sampling, int fixed>
float evaluate(const float* texel, int given, float z) {
    const int nodes = fixed > 0 ? fixed : given;
    const float* values = texel + nodes;
    const Sides at = around<fixed>(texel, nodes, z);
    if (at.left == at.right) return values[at.right];
    return join_nodes<sampling>({texel[at.left], values[at.left]}, {texel[at.right], values[at.right]}, z);
}

template <Sampling sampling, int fixed>
void evaluate_reads(Reads& reads, const std::array<float, block_queries>& depths, int given) {
    if constexpr (sampling == Sampling::exponential) {
        for (std::size_t r = 0; r < reads.count; ++r)
            reads.value[r] = evaluate<sampling, fixed>(reads.texel[r], given, depths[reads.query[r]]);
        return;
    }
    const int nodes = fixed > 0 ? fixed : given;
    Joins joins;
    for (std::size_t r = 0; r < reads.count; ++r) {
        const float* texel = reads.texel[r];
        const float z = depths[reads.query[r]];
        const Sides at = around<fixed>(texel, nodes, z);
        joins.z[r] = z;
        joins.left_z[r] = texel[at.left];
        joins.right_z[r] = texel[at.right];
        joins.left_value[r] = texel[nodes + at.left];
        joins.right_value[r] = texel[nodes + at.right];
    }
    join(joins, reads.count, reads.value.data());
}

// Calls choose.operator()<fixed>() with the fixed number of nodes that there are functions for, or 0.
template <class Choose>
auto with_fixed(int nodes, const Choose& choose) {
    switch (nodes) {
        case 4:
            return choose.template operator()<4>();
        case 8:
            return choose.template operator()<8>();
        case 12:
            return choose.template operator()<12>();
        case 16:
            return choose.template operator()<16>();
        default:
            return choose.template operator()<0>();
    }
}

}  // namespace

TexelEvaluator texel_evaluator(int nodes, Sampling sampling) {
    return with_fixed(nodes, [&]<int fixed>() -> TexelEvaluator {
        return sampling == Sampling::linear ? evaluate<Sampling::linear, fixed>
                                            : evaluate<Sampling::exponential, fixed>;
    });
}

ReadsEvaluator reads_evaluator(int nodes, Sampling sampling) {
    return with_fixed(nodes, [&]<int fixed>() -> ReadsEvaluator {
        return sampling == Sampling::linear ? evaluate_reads<Sampling::linear, fixed>
                                            : evaluate_reads<Sampling::exponential, fixed>;
    });
}

}  // namespace shadowbench::techniques
