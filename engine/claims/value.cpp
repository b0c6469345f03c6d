#include "claims/value.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace shadowbench::claims {

Value exactly(double value) {
    return {value, value, value};
}

Value of(const results::Sample& sample) {
    return {sample.median, sample.interval.low, sample.interval.high};
}

Value operator/(const Value& a, const Value& b) {
    return {a.value / b.value, a.low / b.high, a.high / b.low};
}

Value operator+(const Value& a, const Value& b) {
    return {a.value + b.value, a.low + b.low, a.high + b.high};
}

Value operator-(const Value& a, const Value& b) {
    return {a.value - b.value, a.low - b.high, a.high - b.low};
}

Value operator*(double factor, const Value& a) {
    return {factor * a.value, factor * a.low, factor * a.high};
}

Value absolute(const Value& a) {
    const double low = std::abs(a.low), high = std::abs(a.high);
    const bool holds_zero = a.low <= 0.0 && a.high >= 0.0;
    return {std::abs(a.value), holds_zero ? 0.0 : std::min(low, high), std::max(low, high)};
}

Value least(const Value& a, const Value& b) {
    return {std::min(a.value, b.value), std::min(a.low, b.low), std::min(a.high, b.high)};
}

Value largest(const Value& a, const Value& b) {
    return {std::max(a.value, b.value), std::max(a.low, b.low), std::max(a.high, b.high)};
}

Value error_of(const results::Cell& cell) {
    if (!cell.lookup->interval) return exactly(cell.lookup->norms.rms);
    return rms_between(cell.lookup->interval->low, cell.lookup->interval->high);
}

Value rms_between(double low, double high) {
    const double middle = std::sqrt(0.5 * (low * low + high * high));
    return {std::clamp(middle, low, high), low, high};  // a rounding would else put it outside a narrow interval
}

std::string to_text(const Value& value) {
    if (value.low == value.high) return fmt::format("{:.3g}", value.value);
    return fmt::format("{:.3g} [{:.3g}, {:.3g}]", value.value, value.low, value.high);
}

}  // namespace shadowbench::claims
