#include "recommend/error_interval.h"

#include <algorithm>
#include <cmath>

#include "metrics/student.h"

namespace shadowbench::recommend {

double norm_of(const metrics::ErrorNorms& norms, Measure measure) {
    return measure == Measure::rms ? norms.rms : measure == Measure::max ? norms.max : norms.p99;
}

metrics::Interval error_interval(std::span<const double> errors, Measure measure, const TruthDoubt& truth) {
    metrics::Interval interval = metrics::mean_interval(errors);
    const double low = std::max(interval.low, 0.0);
    switch (measure) {
        case Measure::rms: interval.low = std::sqrt(std::max(0.0, low * low - truth.rms * truth.rms)); break;
        case Measure::max:
        case Measure::p99: interval.low = std::max(0.0, low - truth.max); break;
        case Measure::curve: interval.low = low; break;
    }
    return interval;
}

}  // namespace shadowbench::recommend
