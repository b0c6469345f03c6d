// Exact tests of one ray against one primitive, in view space. A ray is the line of points (x, y) + z * slope.
// Orthographic rays have slope 0 and start at the sample's (x, y); perspective rays start at the light and have the
// sample's (x, y) as slope. All tests compute in double, on coordinates stored as float.
#pragma once

#include <cmath>

#include "base/vec.h"

namespace shadowbench::rays {

// Distances of points from a ray, measured across the ray. `flat` is the point's position minus the ray's at that
// depth.
template <bool perspective>
struct RayMetric {
    double sx = 0, sy = 0;       // slope; 0 if orthographic
    double inverse_length2 = 1;  // 1 / (1 + slope^2)
    double px = 0, py = 0;

    RayMetric(double x, double y) {
        if constexpr (perspective) {
            sx = x;
            sy = y;
            inverse_length2 = 1.0 / (1.0 + x * x + y * y);
        } else {
            px = x;
            py = y;
        }
    }
    base::Vec2d flat(const base::Vec3f& p) const {
        if constexpr (perspective)
            return {p.x - sx * p.z, p.y - sy * p.z};
        else
            return {p.x - px, p.y - py};
    }
    double along(const base::Vec2d& a) const { return a.x * sx + a.y * sy; }
    // The dot product of the components of a and b across the ray.
    double dot(const base::Vec2d& a, const base::Vec2d& b) const {
        if constexpr (perspective)
            return a.x * b.x + a.y * b.y - along(a) * along(b) * inverse_length2;
        else
            return a.x * b.x + a.y * b.y;
    }
};

// One segment of a strand: view-space ends and half-widths. `joined` if an earlier segment of the strand ends at a.
struct HairSegment {
    base::Vec3f a, b;
    float radius_a, radius_b;
    bool joined;
};

// The ribbon faces the ray and has round ends. Writes the depth at which the ray passes its axis. The disc around a
// joint belongs to the earlier segment: the same arithmetic on the same shared point decides for both, so the ray
// crosses the joint exactly once.
template <class Metric>
bool cross_hair(const HairSegment& s, const Metric& ray, double& z) {
    const base::Vec2d a = ray.flat(s.a), b = ray.flat(s.b);
    const double ra = s.radius_a, rb = s.radius_b;
    const bool in_a = ray.dot(a, a) <= ra * ra;
    if (in_a && s.joined) return false;
    const base::Vec2d d = b - a;
    const double length2 = ray.dot(d, d);
    double u = length2 > 0.0 ? -ray.dot(a, d) / length2 : 0.0;
    u = u <= 0.0 ? 0.0 : u >= 1.0 ? 1.0 : u;
    const base::Vec2d nearest = a + d * u;
    const double radius = ra + (rb - ra) * u;
    if (!(in_a || ray.dot(b, b) <= rb * rb || ray.dot(nearest, nearest) <= radius * radius)) return false;
    if (ra == 0.0 && rb == 0.0) return false;
    // The ray passes the axis beside it, at the axis' depth along the ray.
    z = s.a.z + (static_cast<double>(s.b.z) - s.a.z) * u + ray.along(nearest) * ray.inverse_length2;
    return true;
}

// A triangle as three edge functions E(x, y) = ex x + ey y + e1 of the sample's view-plane position. Each edge function
// is computed from the ends of its edge in an order that does not depend on the triangle; `flipped` says whether that
// order runs against this triangle. So the two triangles of an edge see opposite signs of the very same number, and a
// sample exactly on the edge belongs to one of them.
struct TriangleSetup {
    double ex[3], ey[3], e1[3];  // edge i lies opposite corner i
    bool flipped[3];
    double z[3];
};

template <bool perspective>
TriangleSetup set_up_triangle(const base::Vec3f& v0, const base::Vec3f& v1, const base::Vec3f& v2) {
    const base::Vec3f* v[3] = {&v0, &v1, &v2};
    TriangleSetup t;
    for (int i = 0; i < 3; ++i) {
        const base::Vec3f* a = v[(i + 1) % 3];
        const base::Vec3f* b = v[(i + 2) % 3];
        const auto before = [](const base::Vec3f& p, const base::Vec3f& q) {
            return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
        };
        t.flipped[i] = before(*b, *a);
        if (t.flipped[i]) std::swap(a, b);
        const double ax = a->x, ay = a->y, az = a->z, bx = b->x, by = b->y, bz = b->z;
        if constexpr (perspective) {  // det(a, b, (x, y, 1))
            t.ex[i] = ay * bz - az * by;
            t.ey[i] = az * bx - ax * bz;
            t.e1[i] = ax * by - ay * bx;
        } else {  // cross(b - a, (x, y) - a)
            t.ex[i] = ay - by;
            t.ey[i] = bx - ax;
            t.e1[i] = ax * by - ay * bx;
        }
        t.z[i] = v[i]->z;
    }
    return t;
}

// Whether the ray crosses the triangle; if so, the depth and the weights of the corners (which sum to 1).
inline bool cross_triangle(const TriangleSetup& t, double x, double y, double& z, double weight[3]) {
    double e[3];
    bool side[3];
    for (int i = 0; i < 3; ++i) {
        e[i] = t.ex[i] * x + t.ey[i] * y + t.e1[i];
        side[i] = (e[i] >= 0.0) != t.flipped[i];
    }
    if (side[0] != side[1] || side[1] != side[2]) return false;
    const double a0 = std::abs(e[0]), a1 = std::abs(e[1]), a2 = std::abs(e[2]);
    const double sum = a0 + a1 + a2;
    if (!(sum > 0.0)) return false;  // edge-on: the ray runs in the triangle's plane
    weight[0] = a0 / sum;
    weight[1] = a1 / sum;
    weight[2] = 1.0 - weight[0] - weight[1];
    z = t.z[0] + weight[1] * (t.z[1] - t.z[0]) + weight[2] * (t.z[2] - t.z[0]);
    return true;
}

}  // namespace shadowbench::rays
