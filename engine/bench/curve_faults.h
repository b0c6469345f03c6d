// How a stored function breaks what its technique promises.
#pragma once

#include <string>

#include "curves/curve.h"
#include "techniques/technique.h"

namespace shadowbench::bench {

inline constexpr double promise_rounding = 1e-6;  // of stored floats, allowed beyond every promise

// How this function breaks a promise; empty if it does not.
std::string fault_of(const curves::Curve& curve, const techniques::Promises& promises);

// How a function breaks its promise of values before and behind all casters; empty if it does not. `early`: it may be
// dark before them. `allowed`: how far the value behind them may lie from that of the reference.
std::string fault_of_ends(const curves::Curve& stored, const curves::Curve& reference, bool early, double allowed);

}  // namespace shadowbench::bench
