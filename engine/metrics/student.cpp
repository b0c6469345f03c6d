#include "metrics/student.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/compensated.h"

namespace shadowbench::metrics {
namespace {

// The continued fraction of the incomplete beta function by Lentz's method; it converges fast for x < (a + 1)/(a + b +
// 2).
double beta_fraction(double a, double b, double x) {
    constexpr double tiny = 1e-300;
    constexpr int most_terms = 1000;
    const auto not_zero = [](double value) { return std::abs(value) < tiny ? tiny : value; };
    double c = 1.0, d = 1.0 / not_zero(1.0 - (a + b) * x / (a + 1.0)), fraction = d;
    for (int m = 1; m <= most_terms; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1.0) * (a + 2 * m));
        d = 1.0 / not_zero(1.0 + even * d);
        c = not_zero(1.0 + even / c);
        fraction *= d * c;
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1.0));
        d = 1.0 / not_zero(1.0 + odd * d);
        c = not_zero(1.0 + odd / c);
        const double step = d * c;
        fraction *= step;
        if (std::abs(step - 1.0) < 1e-15) break;
    }
    return fraction;
}

// The regularised incomplete beta function I_x(a, b), given x and 1 - x.
double incomplete_beta(double a, double b, double x, double rest) {
    if (x <= 0.0) return 0.0;
    if (rest <= 0.0) return 1.0;
    const double front =
        std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log(rest));
    if (x < (a + 1.0) / (a + b + 2.0)) return front * beta_fraction(a, b, x) / a;
    return 1.0 - front * beta_fraction(b, a, rest) / b;
}

constexpr double normal_from = 1e7;  // degrees: the difference is then below 1e-7 of the tail

}  // namespace

double student_tail(double t, double degrees) {
    if (degrees >= normal_from) return 0.5 * std::erfc(t / std::sqrt(2.0));
    const double square = t * t;
    return 0.5 * incomplete_beta(0.5 * degrees, 0.5, degrees / (degrees + square), square / (degrees + square));
}

double student_quantile(double tail, double degrees) {
    if (tail >= 0.5) return 0.0;
    double low = 0.0, high = 1.0;
    while (student_tail(high, degrees) > tail && high < 1e300) {
        low = high;
        high *= 2.0;
    }
    for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (low + high);
        (student_tail(middle, degrees) > tail ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

MeanAndVariance mean_and_variance(std::span<const double> sample) {
    base::CompensatedSum sum, squares;
    const double n = static_cast<double>(sample.size());
    for (const double value : sample) sum.add(value);
    const double mean = sum.value() / n;
    for (const double value : sample) squares.add((value - mean) * (value - mean));
    const bool equal = std::all_of(sample.begin(), sample.end(), [&](double value) { return value == sample[0]; });
    if (equal) return {sample[0], 0.0, sample.size()};  // without the rounding of the sum
    return {mean, squares.value() / (n * (n - 1.0)), sample.size()};
}

Interval mean_interval(const MeanAndVariance& sample, double known, double tail) {
    const double variance = sample.variance + known;
    if (variance <= 0.0) return {sample.mean, sample.mean};
    const double degrees = sample.variance > 0.0 ? (variance / sample.variance) * (variance / sample.variance) *
                                                       (static_cast<double>(sample.count) - 1.0)
                                                 : std::numeric_limits<double>::infinity();
    const double half = student_quantile(tail, degrees) * std::sqrt(variance);
    return {sample.mean - half, sample.mean + half};
}

Interval mean_interval(std::span<const double> sample) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (sample.size() < 2) return {-infinity, infinity};
    return mean_interval(mean_and_variance(sample), 0.0, 0.025);
}

}  // namespace shadowbench::metrics
