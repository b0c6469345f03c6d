#include "curves/norms.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shadowbench::curves {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The piece of a function that begins at the current depth.
struct Cursor {
    CurveView curve;
    std::size_t next = 0;  // first vertex behind the current depth

    double next_z() const { return next < curve.size() ? curve[next].z : kInfinity; }
    void advance(double z) {
        while (next < curve.size() && curve[next].z <= z) ++next;
    }
    // The value of the piece at z, ends included: the limit from the left at its end, from the right at its begin.
    double value(double z) const {
        if (curve.empty()) return 1.0;
        if (next == 0) return curve.front().value;
        if (next == curve.size()) return curve.back().value;
        const Vertex &a = curve[next - 1], &b = curve[next];
        if (z == b.z) return b.value;
        return a.value + (static_cast<double>(b.value) - a.value) * ((z - a.z) / (static_cast<double>(b.z) - a.z));
    }
};

// The integral of |d| where d runs linearly from d0 to d1 over a length of 1.
double absolute_mean(double d0, double d1) {
    const double sum = std::abs(d0) + std::abs(d1);
    if (sum == 0.0) return 0.0;
    return d0 * d1 >= 0.0 ? 0.5 * sum : 0.5 * (d0 * d0 + d1 * d1) / sum;
}

double square_mean(double d0, double d1) {
    return (d0 * d0 + d0 * d1 + d1 * d1) / 3.0;
}

}  // namespace

Distance distance(CurveView a, CurveView b, double z_low, double z_high) {
    Cursor first{a}, second{b};
    Distance result;
    double squares = 0.0;  // terms of one sign: a plain sum in double loses nothing that matters
    double from = -kInfinity;
    while (true) {
        const double to = std::min(first.next_z(), second.next_z());
        const auto difference = [&](double z) { return first.value(z) - second.value(z); };
        // The outermost pieces are constant, so any depth serves there.
        const double d0 = difference(std::isfinite(from) ? from : 0.0);
        const double d1 = difference(std::isfinite(to) ? to : 0.0);
        for (const double d : {d0, d1}) result.max = std::max(result.max, std::isnan(d) ? kInfinity : std::abs(d));

        const double low = std::max(from, z_low), high = std::min(to, z_high);
        if (low < high) {
            const double at_low = low == from ? d0 : difference(low), at_high = high == to ? d1 : difference(high);
            if (at_low != 0.0 || at_high != 0.0) {  // an infinite piece without a difference adds nothing
                result.l1 += (high - low) * absolute_mean(at_low, at_high);
                squares += (high - low) * square_mean(at_low, at_high);
            }
        }
        if (to == kInfinity) break;
        first.advance(to);
        second.advance(to);
        from = to;
    }
    result.l2 = std::sqrt(squares);
    return result;
}

}  // namespace shadowbench::curves
