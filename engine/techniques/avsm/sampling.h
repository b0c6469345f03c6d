// The curve of a texel between two nodes (Salvi et al. 2010, section 3.3).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "curves/curve.h"

namespace shadowbench::techniques {

enum class Sampling {
    linear,       // transmittance is linear
    exponential,  // extinction is constant: the logarithm of transmittance is linear
};

// The value at `share` in [0, 1] of the way between two nodes of constant extinction, before >= behind. A transmittance
// of 0 counts as the smallest normal float until its end, as in every medium.
inline float decay(float before, float behind, float share) {
    if (before == behind || before <= 0.0f) return before;
    const float ratio = std::max(behind, std::numeric_limits<float>::min()) / before;
    return std::clamp(before * std::exp(share * std::log(ratio)), behind, before);
}

// The value at z between two nodes, left.z < z <= right.z.
template <Sampling sampling>
float join_nodes(const curves::Vertex& left, const curves::Vertex& right, float z) {
    if constexpr (sampling == Sampling::linear) return curves::join(left, right, z);
    if (z == right.z) return right.value;
    const double share = (static_cast<double>(z) - left.z) / (static_cast<double>(right.z) - left.z);
    return decay(left.value, right.value, static_cast<float>(share));
}

}  // namespace shadowbench::techniques
