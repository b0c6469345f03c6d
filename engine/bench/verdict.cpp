#include "bench/verdict.h"

#include <cmath>

#include <fmt/format.h>

namespace shadowbench::bench {
namespace {

// What a verdict without a bound goes by.
struct Strayed {
    double error;
    std::string text;
};

Strayed strayed(const Cell& cell) {
    if (cell.curve) {
        const double error = cell.curve->norms.max;
        return {error, fmt::format("curve error {:.3g}", error)};
    }
    const double error = cell.lookup ? cell.lookup->norms.rms : 0.0;
    return {error, fmt::format("lookup error rms {:.3g}", error)};
}

// How far functions rise and fall below 0 that promise neither.
std::string faults(const Cell& cell) {
    constexpr double rounding = 1e-6;
    std::string text;
    if (!cell.curve) return text;
    if (!cell.promises.monotone && cell.curve->rise > rounding)
        text += fmt::format("; rises by up to {:.3g}", cell.curve->rise);
    if (!cell.promises.unit_range && cell.curve->lowest < -rounding)
        text += fmt::format("; falls to {:.3g}", cell.curve->lowest);
    return text;
}

// Why no bound is promised.
std::string cause(const Cell& cell) {
    if (cell.outside_promise) return "made for opaque scenes, and this one lets light through";
    if (!cell.curve) return "stores no function, and promises no bound on the noise of its answers";
    if (cell.promises.approximate)
        return fmt::format("approximates, by up to {:.2g} even behind all that casts shadows", cell.promises.leak);
    if (!cell.promises.localised) return "exact only before and behind all that casts shadows";
    return fmt::format("promises no bound on its error (at most {} node{} a function here)", cell.nodes.max,
                       cell.nodes.max == 1 ? "" : "s");
}

}  // namespace

Judgement judge(const Cell& cell, const LightResult& light) {
    if (cell.status == CellStatus::failed) return {Verdict::failed, cell.reason};
    if (cell.curve && std::isfinite(cell.error_bound) && !cell.outside_promise)
        return {Verdict::kept, fmt::format("curve error {:.3g}, promised {:.3g}{}", cell.curve->norms.max,
                                           cell.error_bound, faults(cell))};
    const Strayed far = strayed(cell);
    const double noise = light.reference.noise_tolerance;
    if (far.error <= noise)
        return {Verdict::kept, fmt::format("{}, within the noise tolerance {:.3g}{}", far.text, noise, faults(cell))};
    return {Verdict::degraded,
            fmt::format("{}: {}, noise tolerance {:.3g}{}", cause(cell), far.text, noise, faults(cell))};
}

const char* to_string(Verdict verdict) {
    return verdict == Verdict::kept ? "kept" : verdict == Verdict::degraded ? "degraded" : "failed";
}

}  // namespace shadowbench::bench
