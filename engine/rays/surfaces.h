// Orders the surfaces that a ray crosses.
#pragma once

#include <vector>

#include "rays/traced_geometry.h"

namespace shadowbench::rays {

// Sorts crossings of one ray by depth and, at equal depth, by object and primitive. Removes only duplicates: a ray
// through an edge or a corner of a mesh crosses one of the triangles that meet there.
void order_crossings(const TracedRay& ray, std::vector<Crossing>& crossings);

// Appends the hits of ordered crossings to `out`, up to and including the first behind which no channel transmits
// anything; returns true if there is one. Completes them: position, and the normal at unit length and facing the ray's
// origin.
bool take_surfaces(const TracedRay& ray, const std::vector<Crossing>& crossings, std::vector<SurfaceHit>& out);

}  // namespace shadowbench::rays
