// Many values between two nodes at once.
#pragma once

#include <array>
#include <cstddef>

#include "techniques/store/reads.h"

namespace shadowbench::techniques {

// The nodes on both sides of a depth, left.z < z <= right.z; or twice the same node, whose value counts.
struct Joins {
    static constexpr std::size_t most = Reads::most;
    alignas(64) std::array<float, most> z, left_z, right_z, left_value, right_value;
};

// The values of the first `count`, with the bits of curves::join.
void join(const Joins& joins, std::size_t count, float* values);

}  // namespace shadowbench::techniques
