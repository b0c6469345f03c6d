// The part of a convex polygon inside a pixel.
#pragma once

#include <array>
#include <vector>

namespace shadowbench::claims {

// Corners (x, y) in their order around a convex polygon.
using Polygon = std::vector<std::array<double, 2>>;

// The area of the part in [x, x + 1] x [y, y + 1]: cut by one side of the pixel after the other (Sutherland and Hodgman
// 1974).
double area_inside(const Polygon& polygon, double x, double y);

}  // namespace shadowbench::claims
