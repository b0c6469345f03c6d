// Profiles: a number over equal steps of place.
#pragma once

#include <span>

namespace shadowbench::claims {

// Where the values first reach this level, in steps from the first value, which is below it: linear between two values.
// The number of values if they never do.
double first_reached(std::span<const double> values, double level);

}  // namespace shadowbench::claims
