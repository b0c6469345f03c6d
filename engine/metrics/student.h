// Student's t distribution.
#pragma once

#include <cstddef>
#include <span>

#include "metrics/statistics.h"

namespace shadowbench::metrics {

// The probability that a variable of Student's distribution exceeds t >= 0. `degrees` is above 0 and need not be whole;
// infinity gives the normal distribution. By the incomplete beta function: Abramowitz and Stegun 1964, 26.7.1 and
// 26.5.8.
double student_tail(double t, double degrees);

// The t that is exceeded with probability `tail`, in (0, 0.5].
double student_quantile(double tail, double degrees);

// The mean of a sample and the variance of that mean, s^2 / n. The sample must not be empty; the variance of one value
// is 0, which says nothing about its uncertainty.
struct MeanAndVariance {
    double mean = 0.0, variance = 0.0;
    std::size_t count = 0;
};
MeanAndVariance mean_and_variance(std::span<const double> sample);

// Interval for the expectation of a normal sample of at least 2 values whose mean has a further, independent error of
// variance `known`: mean -+ t sqrt(s^2 / n + known), where t is exceeded with probability `tail`. The degrees of
// freedom of the sum are Welch and Satterthwaite's (Welch 1947): (s^2/n + known)^2 / ((s^2/n)^2 / (n - 1)). A sample of
// one value counts as exact, and only `known` makes it uncertain.
Interval mean_interval(const MeanAndVariance& sample, double known, double tail);

// The 95 % interval of the expectation of a sample. A sample of one says nothing about its spread: from minus to plus
// infinity.
Interval mean_interval(std::span<const double> sample);

}  // namespace shadowbench::metrics
