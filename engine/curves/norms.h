// Exact distances between two piecewise-linear functions with steps.
#pragma once

#include "curves/curve.h"

namespace shadowbench::curves {

struct Distance {
    double max = 0.0;  // supremum over all z of |a - b|, both one-sided limits at every step
    double l1 = 0.0;   // integral of |a - b| over [z_low, z_high]
    double l2 = 0.0;   // square root of the integral of (a - b)^2 over [z_low, z_high]
};

// Merges the vertices of both, in double. z_low <= z_high bound only the integrals. A NaN counts as infinitely far away
// in `max`.
Distance distance(CurveView a, CurveView b, double z_low, double z_high);

}  // namespace shadowbench::curves
