#include "claims/intervals.h"

#include "claims/fit.h"
#include "metrics/student.h"

namespace shadowbench::claims {

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

}  // namespace shadowbench::claims
