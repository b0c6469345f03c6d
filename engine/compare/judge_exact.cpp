#include <cmath>

#include <fmt/format.h>

#include "compare/judge.h"

namespace shadowbench::compare {
namespace {

Verdict more(Kind kind) {
    return kind == Kind::size ? Verdict::larger : kind == Kind::error ? Verdict::less_accurate : Verdict::slower;
}

Verdict less(Kind kind) {
    return kind == Kind::size ? Verdict::smaller : kind == Kind::error ? Verdict::more_accurate : Verdict::faster;
}

std::string change_text(const Exact& baseline, const Exact& current) {
    const double change = current.value - baseline.value;
    if (!std::isfinite(change)) return std::isinf(current.value) ? "is not finite now" : "is finite now";
    std::string text = baseline.kind == Kind::error ? fmt::format("{:+.3g}", change) : fmt::format("{:+.0f}", change);
    if (baseline.value > 0.0) text += fmt::format(" ({:+.3g} %)", 100.0 * change / baseline.value);
    return text;
}

}  // namespace

double tolerance_of(const Exact& exact, const Options& options) {
    if (const auto given = options.tolerance.find(exact.name); given != options.tolerance.end()) return given->second;
    return exact.kind == Kind::size ? 0.0 : exact.kind == Kind::error ? 1e-6 : 1e-3;
}

void judge_exact(const Exact& baseline, const Exact& current, const Options& options, Line& line) {
    constexpr double smallest_error = 1e-12;
    line.measure = baseline.name;
    line.baseline = baseline.value;
    line.current = current.value;
    const double tolerance = tolerance_of(baseline, options);
    const double slack = baseline.kind == Kind::error ? smallest_error : 0.0;
    const auto beyond = [&](double value, double than) { return value > than * (1.0 + tolerance) + slack; };
    if (beyond(current.value, baseline.value))
        line.verdict = more(baseline.kind);
    else if (beyond(baseline.value, current.value))
        line.verdict = less(baseline.kind);
    if (baseline.value == current.value) return;
    line.reason = change_text(baseline, current);
    if (tolerance > 0.0) line.reason += fmt::format("; tolerance {:g}", tolerance);
}

}  // namespace shadowbench::compare
