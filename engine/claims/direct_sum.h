// The naive way to average transmittance functions, beside which curves/sweep.h is measured.
#pragma once

#include <span>
#include <vector>

#include "curves/curve.h"
#include "curves/sweep.h"

namespace shadowbench::claims {

// The weighted sum of functions by evaluating each of them at every vertex of all, O(n^2): the naive way of Lokovic and
// Veach 2000, section 5.1. `out` is replaced. `depths` is scratch memory, reused from call to call.
void direct_sum(std::span<const curves::WeightedCurve> terms, std::vector<float>& depths, curves::Curve& out);

}  // namespace shadowbench::claims
