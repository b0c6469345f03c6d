// Splits a polygon of the plane into triangles of its corners. A line sweeps over the corners; what it meets between
// two neighbouring edges is kept as monotone polygons (F. P. Preparata, M. I. Shamos, Computational Geometry, 1985,
// section 6.2; the merging of coincident edges by winding numbers is that of the GLU tessellator). Everything is
// decided in whole numbers, without rounding.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "scene/polygon/monotone.h"

namespace shadowbench::scene {

struct Sweep {
    std::vector<Triple> triangles;  // indices of corners, in left turns, each with an area
    // Two edges that cross, each by the corner it begins at; there are no triangles then.
    std::optional<std::pair<std::uint32_t, std::uint32_t>> crossing;
    // What is wound around twice, or backward: twice its area.
    double overlap = 0.0;
};

// The area that an outline of n corners surrounds, to the left of its edges (corner n - 1 leads back to corner 0).
// Corners may coincide, also with points of other edges. Edges that run over each other there and back cancel out, so
// that a hole may be joined to the outer edge by such a bridge. An edge that crosses another one within `tolerance` of
// a corner is led through that corner: at most 64 times, so that time stays within O(n log n).
Sweep sweep_polygon(const std::vector<GridPoint>& outline, double tolerance);

}  // namespace shadowbench::scene
