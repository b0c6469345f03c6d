#include "bench/ray_sets.h"

#include <cmath>

#include "bench/reference.h"

namespace shadowbench::bench {
namespace {

constexpr double unknown = 0.5;

// Student's t that is exceeded in absolute value with probability 5 %, for 1 to 14 degrees of freedom (Student 1908).
constexpr double student_95[most_ray_sets - 1] = {12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469, 2.3646,
                                                  2.3060,  2.2622, 2.2281, 2.2010, 2.1788, 2.1604, 2.1448};

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
    return {value, std::min(unknown, error * student_95[holding - 2] / student_95[sums.size() - 2])};
}

}  // namespace shadowbench::bench
