#include "metrics/expected_error.h"

#include <algorithm>
#include <cmath>

#include "base/compensated.h"
#include "metrics/student.h"

namespace shadowbench::metrics {

void ErrorsOverSeeds::add(std::span<const double> errors) {
    sum_.resize(errors.size());
    squares_.resize(errors.size());
    for (std::size_t q = 0; q < errors.size(); ++q) {
        sum_[q] += errors[q];
        squares_[q] += errors[q] * errors[q];
    }
    ++seeds_;
}

TruthNoise ErrorsOverSeeds::truth_noise(std::span<const double> standard_error, bool upper_bounds) const {
    TruthNoise noise;
    if (sum_.empty()) return noise;
    const double n = static_cast<double>(sum_.size()), seeds = seeds_;
    base::CompensatedSum variance, linear, fourth;
    for (std::size_t q = 0; q < sum_.size(); ++q) {
        const double mean = sum_[q] / seeds, se2 = standard_error[q] * standard_error[q];
        const double of_mean = seeds_ > 1 ? std::max(0.0, squares_[q] - sum_[q] * mean) / (seeds * (seeds - 1.0)) : 0.0;
        variance.add(se2);
        fourth.add(se2 * se2);
        linear.add(se2 * (mean * mean - of_mean - se2));
    }
    noise.bias = variance.value() / n;
    noise.least_bias = upper_bounds ? 0.0 : noise.bias;
    noise.linear = 4.0 * std::max(0.0, linear.value()) / (n * n);
    noise.quadratic = 2.0 * fourth.value() / (n * n);
    return noise;
}

Interval expected_rms(std::span<const double> mean_squares, const TruthNoise& truth, double confidence) {
    const Interval square =
        mean_interval(mean_and_variance(mean_squares), truth.linear + truth.quadratic, 0.5 * (1.0 - confidence));
    return {std::sqrt(std::max(0.0, square.low - truth.bias)),
            std::sqrt(std::max(0.0, square.high - truth.least_bias))};
}

}  // namespace shadowbench::metrics
