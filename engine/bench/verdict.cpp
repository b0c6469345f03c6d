#include "bench/verdict.h"

#include <cmath>

#include <fmt/format.h>

namespace shadowbench::bench {
namespace {

using results::Cell;
using results::Verdict;
using techniques::Promises;

// The error that decides a verdict without a bound.
struct JudgedError {
    double error;
    std::string text;
};

JudgedError judged_error(const Cell& cell) {
    if (cell.curve) {
        const double error = cell.curve->norms.max;
        return {error, fmt::format("curve error {:.3g}", error)};
    }
    const double error = cell.lookup ? cell.lookup->norms.rms : 0.0;
    return {error, fmt::format("lookup error rms {:.3g}", error)};
}

// How far functions rise or fall below 0, if the technique does not promise that they never do.
std::string faults(const Cell& cell, const Promises& promises) {
    constexpr double rounding = 1e-6;
    std::string text;
    if (!cell.curve) return text;
    if (!promises.monotone && cell.curve->rise > rounding)
        text += fmt::format("; rises by up to {:.3g}", cell.curve->rise);
    if (!promises.unit_range && cell.curve->lowest < -rounding)
        text += fmt::format("; falls to {:.3g}", cell.curve->lowest);
    return text;
}

// Why no bound is promised.
std::string cause(const Cell& cell, const Promises& promises) {
    if (cell.outside_promise) return "made for opaque scenes, and this one lets light through";
    if (!cell.curve) return "stores no function, and promises no bound on the noise of its answers";
    if (promises.approximate)
        return fmt::format("approximates, by up to {:.2g} even behind all that casts shadows", promises.leak);
    if (!promises.localised) return "exact only before and behind all that casts shadows";
    return fmt::format("promises no bound on its error (at most {} node{} a function here)", cell.nodes.max,
                       cell.nodes.max == 1 ? "" : "s");
}

}  // namespace

void judge(Cell& cell, const Promises& promises, double noise) {
    const JudgedError judged = judged_error(cell);
    if (cell.status == results::CellStatus::failed) {
        cell.verdict = Verdict::failed;
        cell.verdict_why = cell.reason;
    } else if (cell.curve && std::isfinite(cell.error_bound) && !cell.outside_promise) {
        cell.verdict = Verdict::kept;
        cell.verdict_why = fmt::format("curve error {:.3g}, promised {:.3g}{}", cell.curve->norms.max, cell.error_bound,
                                       faults(cell, promises));
    } else if (judged.error <= noise) {
        cell.verdict = Verdict::kept;
        cell.verdict_why =
            fmt::format("{}, within the noise tolerance {:.3g}{}", judged.text, noise, faults(cell, promises));
    } else {
        cell.verdict = Verdict::degraded;
        cell.verdict_why = fmt::format("{}: {}, noise tolerance {:.3g}{}", cause(cell, promises), judged.text, noise,
                                       faults(cell, promises));
    }
}

}  // namespace shadowbench::bench
