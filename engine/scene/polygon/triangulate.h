// Splits a polygon in space into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace shadowbench::scene {

struct Polygon {
    std::vector<Vec3f> positions;  // of its corners, in order
    std::vector<Vec2f> uv;         // one for each corner, or empty
};

struct Triangulation {
    std::vector<std::array<std::uint32_t, 3>> triangles;  // indices of corners, in the polygon's sense of rotation
    std::string fault;  // what is wrong with the polygon, corners counted from 1; there are no triangles then
};

// Covers the polygon once, wherever its list of corners begins; a polygon without area has no triangles. Three corners
// give the triangle as it is. Other polygons are seen along Newell's normal (I. E. Sutherland, R. F. Sproull, R. A.
// Schumacker, "A characterization of ten hidden-surface algorithms", 1974); their corners may coincide, lie on one
// line, and lie on other edges. A convex polygon becomes a fan: around its first corner if it is flat, its texture
// coordinates too; otherwise around the corner given by its shorter diagonal (four corners) or by the order of its
// coordinates (more corners). All others are swept (sweep_polygon.h). A polygon is at fault if it crosses itself, or
// covers a part of itself twice or backward, by more than the rounding of its corners in float. Takes O(n log n).
Triangulation triangulate(const Polygon& polygon);

}  // namespace shadowbench::scene
