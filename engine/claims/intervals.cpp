#include "claims/intervals.h"

#include <algorithm>

#include "claims/fit.h"
#include "metrics/student.h"

namespace shadowbench::claims {
namespace {

std::vector<double> ratios(std::span<const double> one, std::span<const double> other) {
    std::vector<double> result;
    for (std::size_t i = 0; i < std::min(one.size(), other.size()); ++i) result.push_back(one[i] / other[i]);
    return result;
}

}  // namespace

Value fitted_exponent(std::span<const std::pair<double, double>> points) {
    const PowerLaw law = fit_power(points);
    const double reach =
        law.standard_error * metrics::student_quantile(0.025, static_cast<double>(points.size()) - 2.0);
    return {law.exponent, law.exponent - reach, law.exponent + reach};
}

Value mean_of(std::span<const double> sample) {
    const metrics::Interval interval = metrics::mean_interval(sample);
    return {metrics::mean_and_variance(sample).mean, interval.low, interval.high};
}

Value median_of(std::vector<double> values) {
    return of(results::summarise(std::move(values)));
}

Value ratio_of(std::span<const double> one, std::span<const double> other) {
    return median_of(ratios(one, other));
}

Value mean_ratio_of(std::span<const double> one, std::span<const double> other) {
    return mean_of(ratios(one, other));
}

}  // namespace shadowbench::claims
