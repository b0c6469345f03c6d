// The error that a setting is judged by, from its errors over seeds of the light rays.
#pragma once

#include <span>

#include "metrics/statistics.h"
#include "recommend/exploration.h"

namespace shadowbench::recommend {

// The norm that a measure of lookups asks for: not of Measure::curve.
double norm_of(const metrics::ErrorNorms& norms, Measure measure);

// The standard error of the truth, over the judged receivers.
struct TruthDoubt {
    double rms = 0.0, max = 0.0;
};

// The 95 % interval of the error expected over seeds: Student's, of at least one error; of one, the upper end is
// infinite. The truth's own error makes a small error look larger: the lower end allows for it, the upper end does not.
metrics::Interval error_interval(std::span<const double> errors, Measure measure, const TruthDoubt& truth);

}  // namespace shadowbench::recommend
