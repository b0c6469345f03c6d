// The ratio of two sums over a population, from a sample of it.
#pragma once

#include <cstddef>
#include <span>

#include "metrics/statistics.h"

namespace shadowbench::metrics {

// The 95 % interval of sum(a) / sum(b) over `population` items, of which those given are a random sample: normal, from
// the variance of the linearised ratio with the correction for a finite population (Cochran 1977, section 6.4). If all
// items are given, or one, it has no width. The sum of b must be above 0.
Interval ratio_interval(std::span<const double> a, std::span<const double> b, std::size_t population);

}  // namespace shadowbench::metrics
