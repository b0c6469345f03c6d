// Pareto fronts: the choices that no other choice beats.
#pragma once

#include <span>
#include <vector>

namespace shadowbench::metrics {

struct CostAndError {
    double cost, error;  // smaller is better; a choice with a non-finite value is never on the front
};

// Whether each choice is on the front: no other has both values at most as large and one of them smaller. O(n log n).
std::vector<bool> pareto_front(std::span<const CostAndError> choices);

}  // namespace shadowbench::metrics
