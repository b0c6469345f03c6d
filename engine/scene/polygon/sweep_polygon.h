// Splits a polygon of the plane into triangles of its corners. A line sweeps over the corners; the areas between
// neighbouring edges that it meets are kept as monotone polygons (F. P. Preparata, M. I. Shamos, Computational
// Geometry, 1985, section 6.2; coincident edges are merged by winding numbers as in the GLU tessellator). All decisions
// use whole numbers, without rounding.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "scene/polygon/monotone.h"

namespace shadowbench::scene {

struct Sweep {
    std::vector<Triple> triangles;  // indices of corners, in left turns, each with an area
    // Two edges that cross, each named by the corner it begins at; there are no triangles then.
    std::optional<std::pair<std::uint32_t, std::uint32_t>> crossing;
    // Twice the area that is wound around twice or backward.
    double overlap = 0.0;
};

// Triangulates the area to the left of an outline of n corners (corner n - 1 leads back to corner 0). Corners may
// coincide, also with points of other edges. Edges that run over each other there and back cancel out, so such a bridge
// may join a hole to the outer edge. An edge that crosses another one within `tolerance` of a corner is led through
// that corner, at most 64 times, so that time stays within O(n log n).
Sweep sweep_polygon(const std::vector<GridPoint>& outline, double tolerance);

}  // namespace shadowbench::scene
