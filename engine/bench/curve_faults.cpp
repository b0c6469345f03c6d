#include "bench/curve_faults.h"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>

namespace shadowbench::bench {

std::string fault_of(const curves::Curve& curve, const techniques::Promises& promises) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
        const double value = curve[i].value;
        if (!std::isfinite(value) || !std::isfinite(curve[i].z)) return "a value is not finite";
        if (i > 0 && curve[i].z < curve[i - 1].z) return "depths are out of order";
        if (promises.unit_range && (value < -promise_rounding || value > 1.0 + promise_rounding))
            return fmt::format("the value {:.9g} at depth {:.9g} is outside [0, 1]", value, curve[i].z);
        if (promises.monotone && i > 0 && value > curve[i - 1].value + promise_rounding)
            return fmt::format("the value rises from {:.9g} to {:.9g} at depth {:.9g}", curve[i - 1].value, value,
                               curve[i].z);
    }
    return {};
}

std::string fault_of_ends(const curves::Curve& stored, const curves::Curve& reference, bool early, double allowed) {
    const auto first = [](const curves::Curve& curve) { return curve.empty() ? 1.0 : curve.front().value; };
    const auto last = [](const curves::Curve& curve) { return curve.empty() ? 1.0 : curve.back().value; };
    if (!early && !(std::abs(first(stored) - first(reference)) <= promise_rounding))
        return fmt::format("before all that casts shadows it is {:.6g} instead of {:.6g}", first(stored),
                           first(reference));
    if (!(std::abs(last(stored) - last(reference)) <= allowed))
        return fmt::format("behind all that casts shadows it is {:.6g} instead of {:.6g}", last(stored),
                           last(reference));
    return {};
}

}  // namespace shadowbench::bench
