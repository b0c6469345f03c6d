// The sweep for rays that hit only surfaces: every event is a step, and steps can be summed exactly.
#pragma once

#include "curves/sweep.h"

namespace shadowbench::curves {

// Whether no segment of the rays [first, first + count), or of the chosen rays, has an extent in depth.
bool surfaces_only(const rays::LightRays& rays, std::size_t first, std::size_t count);
bool surfaces_only(const rays::LightRays& rays, std::span<const WeightedRay> chosen);

// Appends to `out` a pair of vertices, before and after, at each depth where light is lost.
void visibility_of_surfaces(const rays::LightRays& rays, std::size_t first, std::size_t count, int channel,
                            SweepScratch& scratch, Curve& out);

// The same with weights above 0, of which only the ratios matter. They are rounded to 2^-60 of their sum.
void visibility_of_surfaces(const rays::LightRays& rays, std::span<const WeightedRay> chosen, int channel,
                            SweepScratch& scratch, Curve& out);

}  // namespace shadowbench::curves
