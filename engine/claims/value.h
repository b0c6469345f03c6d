// Measured numbers with their intervals.
#pragma once

#include <string>

#include "results/result.h"

namespace shadowbench::claims {

// A number with its interval: 95 % for medians and errors, or the number itself twice if nothing varies.
struct Value {
    double value = 0.0, low = 0.0, high = 0.0;
};
Value exactly(double value);
Value of(const results::Sample& sample);
Value operator/(const Value& a, const Value& b);  // both above 0; the widest interval that the operands allow
Value operator+(const Value& a, const Value& b);
Value operator-(const Value& a, const Value& b);
Value operator*(double factor, const Value& a);
Value absolute(const Value& a);
Value least(const Value& a, const Value& b);
Value largest(const Value& a, const Value& b);

// The RMS lookup error of a cell that is expected over seeds of the light rays against the exact truth, with its
// interval. The value is the middle of the interval of the mean square: the mean of all seeds less the noise of the
// truth. (If the interval was cut at 0, or the noise is only known to be below a bound, it is the middle of what is
// left.)
// If the rays are regular or only one seed was measured, the interval covers the truth's uncertainty only. Exact if the
// result has no interval.
Value error_of(const results::Cell& cell);
// An RMS with this interval: the middle of the interval of the mean square.
Value rms_between(double low, double high);

// "14.2 [13.9, 14.6]", or "14.2" if nothing varies.
std::string to_text(const Value& value);

}  // namespace shadowbench::claims
