#include "metrics/pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shadowbench::metrics {

std::vector<bool> pareto_front(std::span<const CostAndError> choices) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < choices.size(); ++i)
        if (std::isfinite(choices[i].cost) && std::isfinite(choices[i].error)) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return choices[a].cost != choices[b].cost ? choices[a].cost < choices[b].cost
                                                  : choices[a].error < choices[b].error;
    });
    std::vector<bool> front(choices.size(), false);
    double least_error = std::numeric_limits<double>::infinity();  // of all cheaper choices
    for (std::size_t i = 0; i < order.size();) {
        // Among choices of equal cost only the least error counts; equal choices do not beat each other.
        const CostAndError& best = choices[order[i]];
        const bool on_front = best.error < least_error;
        for (; i < order.size() && choices[order[i]].cost == best.cost; ++i)
            front[order[i]] = on_front && choices[order[i]].error == best.error;
        least_error = std::min(least_error, best.error);
    }
    return front;
}

}  // namespace shadowbench::metrics
