// Intervals of fits, of means and of medians.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "claims/value.h"

namespace shadowbench::claims {

// The exponent of the power law that is fitted to at least three points, with the 95 % interval of its standard error:
// Student's t with two degrees of freedom fewer than points.
Value fitted_exponent(std::span<const std::pair<double, double>> points);

// The mean of a sample of at least two, with the 95 % interval of its expectation.
Value mean_of(std::span<const double> sample);

// The median with its 95 % interval, results::summarise().
Value median_of(std::vector<double> values);

// The median of the ratios of two samples whose values were measured in the same rounds, with its interval. What the
// machine did to a whole round is not in it.
Value ratio_of(std::span<const double> one, std::span<const double> other);

// The mean of such ratios with the interval of its expectation, for values that belong together as those of one seed.
Value mean_ratio_of(std::span<const double> one, std::span<const double> other);

}  // namespace shadowbench::claims
