// The sweep where rays hit surfaces alone: every event is a step, and steps can be summed exactly.
#pragma once

#include "curves/sweep.h"

namespace shadowbench::curves {

// Whether no segment of the rays [first, first + count) has an extent.
bool surfaces_only(const rays::LightRays& rays, std::size_t first, std::size_t count);

// Appends to `out`. At each depth where light is lost a pair of vertices, before and after.
void visibility_of_surfaces(const rays::LightRays& rays, std::size_t first, std::size_t count, SweepScratch& scratch,
                            Curve& out);

}  // namespace shadowbench::curves
