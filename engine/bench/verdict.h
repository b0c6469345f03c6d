// One word on a measured cell: whether the technique kept what it promises, did all that it states and yet strayed, or
// broke a promise.
#pragma once

#include "results/result.h"
#include "techniques/technique.h"

namespace shadowbench::bench {

// failed    a promise that the technique makes is broken: the cell failed, and its reason says how.
// kept      every promise holds, and it promises a bound on its curve error in this case (then the bound held), or its
//           error is within the noise tolerance of the light rays, 0.5 / sqrt(N) for N rays a pixel, all the same.
// degraded  every promise holds, but it promises no bound in this case, and its error is above the noise tolerance.
//
// The error is the largest curve error. A technique that stores no function has none: then it is the lookup error, as
// RMS, since the largest of thousands of answers by random rays is several standard deviations from the truth.
// A bound is promised for the scenes that the technique is made for: none where it takes every crossing as opaque and
// this scene lets light through. One that is exact only before and behind all that casts shadows (Promises::localised
// false) is held to that and fails where it is not; between, it promises nothing, so its error decides. So it is of one
// that approximates (Promises::approximate), whose ends are held to Promises::leak.
// Fills in the cell's verdict and its reason.
void judge(results::Cell& cell, const techniques::Promises& promises, double noise_tolerance);

}  // namespace shadowbench::bench
