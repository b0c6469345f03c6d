// exp(-x) in loops that are made of vectors: the same bits on every path, where the C library's may differ.
#pragma once

#include <bit>
#include <cstdint>

#include "base/simd_path.h"

namespace shadowbench::rays {

inline constexpr double most_depth = 700.0;  // exp(-x) is a normal number

// For x in [-1, most_depth], within one unit in the last place of the exact value.
SHADOWBENCH_SIMD_LOOP inline double exp_minus(double x) {
    constexpr double per_ln2 = 1.4426950408889634, ln2_high = 0x1.62e42fee00000p-1, ln2_low = 0x1.a39ef35793c76p-33;
    constexpr double shift = 0x1.8p52;  // added and taken away, it rounds to a whole number
    const double y = -x, shifted = y * per_ln2 + shift, n = shifted - shift;
    const double r = (y - n * ln2_high) - n * ln2_low, r2 = r * r, r4 = r2 * r2;  // |r| <= ln(2) / 2
    // exp(r) = 1 + r + r^2 (1/2! + r/3! + ... + r^11/13!); the terms left out are below 2^-57.
    const double a = (1.0 / 2 + r * (1.0 / 6)) + r2 * (1.0 / 24 + r * (1.0 / 120));
    const double b = (1.0 / 720 + r * (1.0 / 5040)) + r2 * (1.0 / 40320 + r * (1.0 / 362880));
    const double c = (1.0 / 3628800 + r * (1.0 / 39916800)) + r2 * (1.0 / 479001600 + r * (1.0 / 6227020800.0));
    const double power = 1.0 + (r + r2 * (a + r4 * (b + r4 * c)));
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(power) + (std::bit_cast<std::uint64_t>(shifted) << 52));
}

}  // namespace shadowbench::rays
