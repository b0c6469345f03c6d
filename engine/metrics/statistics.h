// Norms of errors, and the median of a sample with its interval.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace shadowbench::metrics {

// Norms of the absolute values of errors. All are 0 if there are no errors. A NaN counts as an infinite error, so that
// it cannot hide and the norms stay comparable.
struct ErrorNorms {
    double max = 0.0;  // L-infinity
    double rms = 0.0;
    double mean = 0.0;
    double p99 = 0.0;  // 99th percentile (nearest rank)
};
ErrorNorms error_norms(std::span<const double> errors);

// The median of an unsorted sample, which must not be empty: the mean of the two middle values if their number is even.
double median(std::span<const double> sample);

struct Interval {
    double low, high;
};
// Bootstrap interval of the median: percentiles of the medians of 2,000 resamples drawn with `seed`
// (Efron 1979). A sample of one gives that value twice.
Interval median_interval(std::span<const double> sample, double confidence = 0.95, std::uint64_t seed = 1);

// Interval of the median between two values of the sample that are equally far from its ends (Thompson 1936): the
// narrowest pair that holds the median of any continuous distribution with at least this confidence, whatever the
// number of values. If the values have different distributions, as those of a machine that slows down, it holds the
// median of their mixture (Hoeffding 1956). Fewer than six values cannot reach 95 %; then it is the whole range, which
// five values reach with 94 %. The sample must not be empty.
Interval order_interval(std::span<const double> sample, double confidence = 0.95);

}  // namespace shadowbench::metrics
