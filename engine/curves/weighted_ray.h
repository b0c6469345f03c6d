// A light ray with its weight, for sums over rays.
#pragma once

#include <cstddef>

namespace shadowbench::curves {

// One light ray of a tile as a term of a weighted sum.
struct WeightedRay {
    std::size_t ray;
    double weight;
};

}  // namespace shadowbench::curves
