// Triangles of a polygon in space.
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
    std::vector<Vec2f> uv;         // one a corner, or empty
};

struct Triangulation {
    std::vector<std::array<std::uint32_t, 3>> triangles;  // indices of corners, turning as the polygon turns
    std::string fault;  // what is wrong with the polygon, corners counted from 1; there are no triangles then
};

// Covers the polygon once, wherever its list of corners begins; a polygon without area has no triangles. Three corners
// are the triangle as it is. Others are looked at along Newell's normal (I. E. Sutherland, R. F. Sproull,
// R. A. Schumacker, "A characterization of ten hidden-surface algorithms", 1974), where corners may coincide, lie on
// one line, and on other edges. A convex polygon is the fan around its first corner if it is flat, its texture
// coordinates too; if not, around the corner that its shorter diagonal (of four corners) or the order of its
// coordinates (of more) tells. All others are swept (sweep_polygon.h). At fault is one that crosses itself, or covers a
// part of itself twice or backward, by more than floats round its corners. O(n log n).
Triangulation triangulate(const Polygon& polygon);

}  // namespace shadowbench::scene
