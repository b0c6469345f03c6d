// Exact tests of one ray against one primitive, in view space. A ray is the line of points (x, y) + z * slope.
// Orthographic rays have slope 0 and start at the sample's (x, y); perspective rays start at the light and have the
// sample's (x, y) as slope. All tests compute in double, on coordinates stored as float.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/vec.h"

namespace shadowbench::rays {

// The position of a point minus that of a ray at the point's depth.
template <class Real>
struct Flat {
    Real x, y;
};

// Distances of points from a ray, measured across the ray. `Real` is double, or a vector of them for as many rays.
template <bool perspective, class R = double>
struct RayMetric {
    using Real = R;
    Real sx{}, sy{};       // slope; 0 if orthographic
    Real inverse_length2;  // 1 / (1 + slope^2)
    Real px{}, py{};

    RayMetric(const Real& x, const Real& y) {
        if constexpr (perspective) {
            sx = x;
            sy = y;
            inverse_length2 = 1.0 / (1.0 + x * x + y * y);
        } else {
            px = x;
            py = y;
            inverse_length2 = Real{} + 1.0;
        }
    }
    Flat<Real> flat(const base::Vec3f& p) const {
        const double x = p.x, y = p.y, z = p.z;
        if constexpr (perspective)
            return {x - sx * z, y - sy * z};
        else
            return {x - px, y - py};
    }
    Real along(const Flat<Real>& a) const { return a.x * sx + a.y * sy; }
    // The dot product of the components of a and b across the ray.
    Real dot(const Flat<Real>& a, const Flat<Real>& b) const {
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

// The ribbon faces the ray and has round ends. Returns the depth at which the ray passes its axis; minus infinity if it
// misses the ribbon. The disc around a joint belongs to the earlier segment: the same arithmetic on the same shared
// point decides for both, so the ray crosses the joint exactly once.
template <class Metric>
[[gnu::always_inline]] inline typename Metric::Real hair_depth(const HairSegment& s, const Metric& ray) {
    using Real = typename Metric::Real;
    const Real zero{}, one = zero + 1.0, missed = zero - std::numeric_limits<double>::infinity();
    const Flat<Real> a = ray.flat(s.a), b = ray.flat(s.b), d{b.x - a.x, b.y - a.y};
    const double ra = s.radius_a, rb = s.radius_b, az = s.a.z, bz = s.b.z;
    const Real length2 = ray.dot(d, d), along_axis = -ray.dot(a, d) / length2;
    Real u = length2 > 0.0 ? along_axis : zero;
    u = u <= 0.0 ? zero : u;
    u = u >= 1.0 ? one : u;
    const Flat<Real> nearest{a.x + d.x * u, a.y + d.y * u};
    const Real radius = ra + (rb - ra) * u;
    // The ray passes the axis beside it, at the axis' depth along the ray.
    const Real z = az + (bz - az) * u + ray.along(nearest) * ray.inverse_length2;
    Real depth = ray.dot(nearest, nearest) <= radius * radius ? z : missed;
    depth = ray.dot(b, b) <= rb * rb ? z : depth;
    depth = ray.dot(a, a) <= ra * ra ? (s.joined ? missed : z) : depth;
    return ra > 0.0 || rb > 0.0 ? depth : missed;
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
