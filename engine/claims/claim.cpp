#include "claims/claim.h"

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

const char* to_string(Verdict verdict) {
    switch (verdict) {
        case Verdict::holds:
            return "holds";
        case Verdict::in_shape:
            return "holds in shape";
        case Verdict::fails:
            return "does not hold here";
        case Verdict::undecided:
            return "undecided";
    }
    return "";
}

Claim undecided(Claim claim, const std::string& reason) {
    claim.verdict = Verdict::undecided;
    claim.why = fmt::format("Undecided until the experiment is done again: {}. {}", reason, claim.why);
    return claim;
}

std::string to_text(const Value& value) {
    if (value.low == value.high) return fmt::format("{:.3g}", value.value);
    return fmt::format("{:.3g} [{:.3g}, {:.3g}]", value.value, value.low, value.high);
}

namespace {

template <class Judge>
Verdict worst(const Value& measured, const Judge& judge) {
    return std::max({judge(measured.value), judge(measured.low), judge(measured.high)});
}

Verdict judge_factor(double paper, double measured, double near, bool gain) {
    if (!std::isfinite(measured) || measured <= 0.0) return Verdict::fails;
    const double theirs = std::log(paper), ours = std::log(measured);
    const bool same_side = (theirs > 0.0) == (ours > 0.0);
    if (std::abs(theirs - ours) <= std::log(near)) return Verdict::holds;
    if (gain && same_side && std::abs(ours) >= std::abs(theirs)) return Verdict::holds;
    return same_side ? Verdict::in_shape : Verdict::fails;
}

}  // namespace

Verdict judge_ratio(double paper, const Value& measured, double near) {
    return worst(measured, [&](double value) { return judge_factor(paper, value, near, false); });
}

Verdict judge_gain(double paper, const Value& measured, double near) {
    return worst(measured, [&](double value) { return judge_factor(paper, value, near, true); });
}

Verdict judge_value(double paper, const Value& measured, double tolerance, double shape) {
    return worst(measured, [&](double value) {
        const double apart = std::abs(value - paper);
        return apart <= tolerance ? Verdict::holds : apart <= shape ? Verdict::in_shape : Verdict::fails;
    });
}

Verdict judge_at_most(const Value& measured, double holds, double shape) {
    return worst(measured, [&](double value) {
        return value <= holds ? Verdict::holds : value <= shape ? Verdict::in_shape : Verdict::fails;
    });
}

}  // namespace shadowbench::claims
