// The verdict on a measured cell: whether the technique kept its promises, kept them with a large error, or broke one.
//
// failed    the technique broke a promise: the cell failed, and its reason says how.
// kept      every promise holds, and either a bound on the curve error is promised in this case (and held), or the
//           error is within the noise tolerance of the light rays, 0.5 / sqrt(N) for N rays a pixel.
// degraded  every promise holds, but none bounds the error in this case, and the error is above the noise tolerance.
//
// The error is the largest curve error. For a technique that stores no function it is the RMS of its lookup errors: the
// largest error of thousands of answers from random rays is several standard deviations.
// A bound is promised only for scenes that the technique is made for: not if it takes every crossing as opaque and the
// scene lets light through. A technique that is exact only before and behind all casters (Promises::localised is false)
// fails if it is not exact there; in between it promises nothing, so its error decides. The same holds for a technique
// that approximates (Promises::approximate), whose values there may err by Promises::leak.
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
// Sets the cell's verdict and verdict_why.
void judge(results::Cell& cell, const techniques::Promises& promises, double noise_tolerance);

}  // namespace shadowbench::bench
