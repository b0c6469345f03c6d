#include "claims/equal_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace shadowbench::claims {
namespace {

// `end` of a value: its middle, or one of the ends of its interval.
double cost_along(std::span<const CostAtError> settings, double Value::*end, double error) {
    std::size_t next = 1;
    while (next + 1 < settings.size() && settings[next].error.*end > error) ++next;
    const CostAtError &coarse = settings[next - 1], &fine = settings[next];
    const double way = std::log(coarse.error.*end / error) / std::log(coarse.error.*end / (fine.error.*end));
    return coarse.cost.*end * std::pow(fine.cost.*end / (coarse.cost.*end), std::clamp(way, 0.0, 1.0));
}

}  // namespace

Value cost_at(const Value& error, std::span<const CostAtError> settings) {
    return {cost_along(settings, &Value::value, error.value), cost_along(settings, &Value::low, error.high),
            cost_along(settings, &Value::high, error.low)};
}

}  // namespace shadowbench::claims
