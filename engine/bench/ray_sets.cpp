#include "bench/ray_sets.h"

#include <cmath>

#include "metrics/student.h"

namespace shadowbench::bench {
namespace {

constexpr double unknown = 0.5;

// Student's t that is exceeded in absolute value with probability 5 %, for this number of sets.
double student_95(std::size_t sets) {
    return metrics::student_quantile(0.025, static_cast<double>(sets) - 1.0);
}

}  // namespace

Mean mean_of_rays(const Moments& rays, int channel) {
    const double n = static_cast<double>(rays.count), sum = rays.sum[channel];
    if (rays.count < 2) return {sum / n, unknown};
    const double variance = (rays.squares[channel] - sum * sum / n) / (n - 1.0);
    return {sum / n, std::sqrt(std::max(variance, 0.0) / n)};
}

Mean mean_of_sets(std::span<const double> sums, std::span<const std::uint64_t> counts) {
    double sum = 0.0, count = 0.0, squares = 0.0;
    std::size_t holding = 0;
    for (std::size_t k = 0; k < sums.size(); ++k) {
        sum += sums[k];
        count += static_cast<double>(counts[k]);
        holding += counts[k] > 0;
    }
    const double value = sum / count;
    if (holding < 2) return {value, unknown};
    for (std::size_t k = 0; k < sums.size(); ++k) {
        const double off = sums[k] - value * static_cast<double>(counts[k]);
        squares += off * off;
    }
    const double m = static_cast<double>(holding), error = std::sqrt(squares * m / (m - 1.0)) / count;
    if (holding == sums.size()) return {value, error};
    return {value, std::min(unknown, error * student_95(holding) / student_95(sums.size()))};
}

}  // namespace shadowbench::bench
