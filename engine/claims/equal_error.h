// What a technique costs at the error of another one.
#pragma once

#include <span>

#include "claims/value.h"

namespace shadowbench::claims {

// A technique's error with one of its settings, and what it costs then.
struct CostAtError {
    Value error, cost;
};

// The cost at an error, by the power law between the two settings around it. The settings are at least two, from the
// largest error to the smallest. An error beyond them costs as much as the nearest of them: so it costs at least, or at
// most, as much. The interval takes the errors of the settings all too large, or all too small.
Value cost_at(const Value& error, std::span<const CostAtError> settings);

}  // namespace shadowbench::claims
