#include "metrics/mean_interval.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

namespace shadowbench::metrics {
namespace {

// The 97.5 % point of Student's t for 1 to 30 degrees of freedom; for more, the next smaller entry is on the safe side.
constexpr double t_975[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
                            2.201,  2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086,
                            2.080,  2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042};

}  // namespace

double mean(std::span<const double> sample) {
    return std::accumulate(sample.begin(), sample.end(), 0.0) / static_cast<double>(sample.size());
}

Interval mean_interval(std::span<const double> sample) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (sample.size() < 2) return {-infinity, infinity};
    const double middle = mean(sample), n = static_cast<double>(sample.size());
    double squares = 0.0;
    for (const double value : sample) squares += (value - middle) * (value - middle);
    const std::size_t freedom = std::min(sample.size() - 1, std::size(t_975));
    const double half = t_975[freedom - 1] * std::sqrt(squares / (n - 1.0) / n);
    return {middle - half, middle + half};
}

}  // namespace shadowbench::metrics
