// The mean of a sample with its interval.
#pragma once

#include <span>

#include "metrics/statistics.h"

namespace shadowbench::metrics {

double mean(std::span<const double> sample);

// 95 % interval of the mean of the distribution that the sample was drawn from, by Student's t (1908): mean -+ t s /
// sqrt(n). A sample of one says nothing about its spread: from minus to plus infinity.
Interval mean_interval(std::span<const double> sample);

}  // namespace shadowbench::metrics
