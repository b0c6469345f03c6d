// Sine and cosine from only additions and multiplications, so that procedural scenes have the same bits on every
// machine: the C library's results differ in the last place between its versions and instruction sets.
#pragma once

#include <cmath>

#include "base/random.h"
#include "base/vec.h"

namespace shadowbench::scene {

struct Turn {
    double cosine, sine;
};

// Sine and cosine of an angle in whole turns; the error is below 1e-14.
inline Turn turn(double turns) {
    const double quarters = std::floor(turns * 4.0 + 0.5);
    const double angle = (turns * 4.0 - quarters) * 1.57079632679489661923;  // in [-pi/4, pi/4]
    const double square = angle * angle;
    // Taylor series, nested: the first omitted term is below 1e-17 there.
    double sine = 1.0, cosine = 1.0;
    for (int n = 16; n >= 2; n -= 2) {
        sine = 1.0 - square * sine / (n * (n + 1.0));
        cosine = 1.0 - square * cosine / (n * (n - 1.0));
    }
    sine *= angle;
    const double phase = quarters - 4.0 * std::floor(quarters / 4.0);  // 0, 1, 2 or 3 quarter turns
    if (phase == 0.0) return {cosine, sine};
    if (phase == 1.0) return {-sine, cosine};
    if (phase == 2.0) return {-cosine, -sine};
    return {sine, -cosine};
}

// Two unit vectors perpendicular to a unit vector (Duff et al., Building an Orthonormal Basis, Revisited, 2017).
struct Across {
    base::Vec3d u, v;
};
inline Across across(const base::Vec3d& n) {
    const double sign = n.z < 0.0 ? -1.0 : 1.0;
    const double a = -1.0 / (sign + n.z);
    const double b = n.x * n.y * a;
    return {{1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

// A uniform point in the unit disc.
inline base::Vec2d in_disc(base::Random& random) {
    const double radius = std::sqrt(random.uniform());
    const Turn at = turn(random.uniform());
    return {radius * at.cosine, radius * at.sine};
}

}  // namespace shadowbench::scene
