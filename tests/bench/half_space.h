// The part of a box of two or three dimensions that lies on one side of a plane.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/vec.h"

namespace shadowbench::bench::testing {

// The share of the unit cube where a . u < b: inclusion and exclusion over the corners. No part of a may be 0.
inline double half_space_in_cube(std::array<double, 3> a, double b) {
    double divisor = 6.0;
    for (double& v : a) {
        if (v < 0.0) {  // u becomes 1 - u
            b -= v;
            v = -v;
        }
        divisor *= v;
    }
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        double rest = b, sign = 1.0;
        for (int k = 0; k < 3; ++k)
            if (corner >> k & 1) {
                rest -= a[static_cast<std::size_t>(k)];
                sign = -sign;
            }
        if (rest > 0.0) sum += sign * rest * rest * rest;
    }
    return sum / divisor;
}

// A convex polygon, corner after corner.
using Polygon = std::vector<base::Vec2d>;

// The part of the polygon where n . p < d (Sutherland and Hodgman 1974).
inline Polygon clip(const Polygon& polygon, const base::Vec2d& n, double d) {
    Polygon inside;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const base::Vec2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double at_a = n.dot(a) - d, at_b = n.dot(b) - d;
        if (at_a < 0.0) inside.push_back(a);
        if ((at_a < 0.0) != (at_b < 0.0)) inside.push_back(a + (b - a) * (at_a / (at_a - at_b)));
    }
    return inside;
}

inline double area(const Polygon& polygon) {
    double twice = 0.0;
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        const base::Vec2d a = polygon[i - 1] - polygon[0], b = polygon[i] - polygon[0];
        twice += a.x * b.y - a.y * b.x;
    }
    return 0.5 * twice;
}

}  // namespace shadowbench::bench::testing
