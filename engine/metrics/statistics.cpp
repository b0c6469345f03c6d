#include "metrics/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/compensated.h"
#include "base/random.h"

namespace shadowbench::metrics {

namespace {

// Reorders the sample.
double median_of(std::vector<double>& sample) {
    const std::size_t half = sample.size() / 2;
    const auto middle = sample.begin() + static_cast<std::ptrdiff_t>(half);
    std::nth_element(sample.begin(), middle, sample.end());
    const double upper = *middle;
    if (sample.size() % 2 == 1) return upper;
    return 0.5 * (*std::max_element(sample.begin(), middle) + upper);
}

}  // namespace

ErrorNorms error_norms(std::span<const double> errors) {
    ErrorNorms norms;
    if (errors.empty()) return norms;
    std::vector<double> sizes(errors.size());
    base::CompensatedSum sum, squares;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        sizes[i] = std::isnan(errors[i]) ? std::numeric_limits<double>::infinity() : std::abs(errors[i]);
        norms.max = std::max(norms.max, sizes[i]);
    }
    const std::size_t rank = sizes.size() - sizes.size() / 100;  // ceil(0.99 n)
    const auto nearest = sizes.begin() + static_cast<std::ptrdiff_t>(rank - 1);
    std::nth_element(sizes.begin(), nearest, sizes.end());
    norms.p99 = *nearest;
    if (std::isinf(norms.max)) {  // a compensated sum would turn infinity into NaN
        norms.mean = norms.rms = norms.max;
        return norms;
    }
    for (const double size : sizes) {
        sum.add(size);
        squares.add(size * size);
    }
    const double count = static_cast<double>(sizes.size());
    norms.mean = sum.value() / count;
    norms.rms = std::sqrt(squares.value() / count);
    return norms;
}

double median(std::span<const double> sample) {
    std::vector<double> copy(sample.begin(), sample.end());
    return median_of(copy);
}

Interval median_interval(std::span<const double> sample, double confidence, std::uint64_t seed) {
    constexpr std::size_t kResamples = 2000;
    if (sample.size() == 1) return {sample[0], sample[0]};
    base::Random random(base::mix(seed));
    std::vector<double> resample(sample.size()), medians(kResamples);
    for (double& value : medians) {
        for (double& drawn : resample) drawn = sample[random.below(sample.size())];
        value = median_of(resample);
    }
    std::sort(medians.begin(), medians.end());
    const double tail = 0.5 * (1.0 - std::clamp(confidence, 0.0, 1.0));
    const auto low = std::min(static_cast<std::size_t>(std::floor(tail * kResamples)), kResamples / 2 - 1);
    return {medians[low], medians[kResamples - 1 - low]};
}

Interval order_interval(std::span<const double> sample, double confidence) {
    std::vector<double> sorted(sample.begin(), sample.end());
    std::sort(sorted.begin(), sorted.end());
    const std::size_t n = sorted.size();
    // The probability that at most `below` of n values are under the median: a sum of binomial terms.
    double term = std::pow(0.5, static_cast<double>(n)), tail = term;
    std::size_t below = 0;
    while (2 * (below + 1) < n) {
        const double next = term * static_cast<double>(n - below) / static_cast<double>(below + 1);
        if (2.0 * (tail + next) > 1.0 - confidence) break;
        term = next;
        tail += next;
        ++below;
    }
    return {sorted[below], sorted[n - 1 - below]};
}

}  // namespace shadowbench::metrics
