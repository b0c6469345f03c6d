// Primitives that move in a straight line while the shutter is open, seen by rays that each have their own time: the
// exact tests of primitives.h on moved primitives, and their bounds. Primitives are given at time 0; an offset is how
// far they have moved, in view space.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "base/vec.h"
#include "rays/bins.h"
#include "rays/light_view.h"
#include "rays/primitives.h"
#include "rays/tile_grid.h"

namespace shadowbench::rays {

// Distances of moved points from a ray.
template <bool perspective>
struct MovedRayMetric : RayMetric<perspective> {
    Flat<double> offset;

    MovedRayMetric(double x, double y, const Vec3d& moved) : RayMetric<perspective>(x, y) {
        if constexpr (perspective)
            offset = {moved.x - x * moved.z, moved.y - y * moved.z};
        else
            offset = {moved.x, moved.y};
    }
    Flat<double> flat(const base::Vec3f& p) const {
        const Flat<double> still = RayMetric<perspective>::flat(p);
        return {still.x + offset.x, still.y + offset.y};
    }

    // Whether the ray surely misses the segment: both ends are on one side of the ray, farther than `reach` (half-width
    // times the ray's length per depth: distances in the plane are longer than those across the ray by at most this
    // factor).
    bool misses(const HairSegment& s, double reach) const {
        const Flat<double> a = flat(s.a), b = flat(s.b);
        return std::min(a.x, b.x) > reach || std::max(a.x, b.x) < -reach || std::min(a.y, b.y) > reach ||
               std::max(a.y, b.y) < -reach;
    }
};

// The edge functions of a triangle are linear in time: det(a + m t, b + m t, d) = det(a, b, d) + t det(m, b - a, d),
// and likewise for parallel rays. Here, too, both triangles of an edge compute the same numbers.
struct MovingTriangle {
    TriangleSetup start;            // at time 0
    double ex[3], ey[3], e1[3], z;  // growth per unit of time
};

template <bool perspective>
MovingTriangle set_up_moving_triangle(const base::Vec3f& v0, const base::Vec3f& v1, const base::Vec3f& v2,
                                      const Vec3d& motion) {
    const base::Vec3f* v[3] = {&v0, &v1, &v2};
    MovingTriangle t;
    t.start = set_up_triangle<perspective>(v0, v1, v2);
    t.z = motion.z;
    for (int i = 0; i < 3; ++i) {
        const Vec3d a(*v[(i + 1) % 3]), b(*v[(i + 2) % 3]);
        const Vec3d growth = motion.cross(t.start.flipped[i] ? a - b : b - a);
        t.ex[i] = perspective ? growth.x : 0.0;
        t.ey[i] = perspective ? growth.y : 0.0;
        t.e1[i] = growth.z;
    }
    return t;
}

inline TriangleSetup at_time(const MovingTriangle& triangle, double time) {
    TriangleSetup t = triangle.start;
    for (int i = 0; i < 3; ++i) {
        t.ex[i] += time * triangle.ex[i];
        t.ey[i] += time * triangle.ey[i];
        t.e1[i] += time * triangle.e1[i];
        t.z[i] += time * triangle.z;
    }
    return t;
}

// Where a primitive is seen once it has moved by an offset: its view-plane bounds, which are valid only if all of it
// lies behind the near plane; its depths; and itself, as what lies within `radius` of the hull of `count` points.
struct Placed {
    PlaneBox box;
    double z_low, z_high;
    std::array<Vec3d, 3> points;
    std::size_t count;
    double radius;
};
Placed place_sphere(const LightView& view, const base::Vec3f& centre, double radius, const Vec3d& offset);
Placed place_triangle(const LightView& view, const base::Vec3f& a, const base::Vec3f& b, const base::Vec3f& c,
                      const Vec3d& offset);
Placed place_hair(const LightView& view, const HairSegment& segment, const Vec3d& offset);

// View-plane bounds of all that a primitive covers, behind the near plane, on its straight way between two positions.
PlaneBox swept(const LightView& view, const Placed& from, const Placed& to);

// Calls visit(ray, offset at the ray's time) for every ray that may meet a primitive; place(offset) returns where it
// is. Goes through the shutter part by part, with one ray of each pixel, so that the work depends little on how far
// things move (as in the interval algorithm of Fatahalian et al., Data-Parallel Rasterization of Micropolygons with
// Defocus and Motion Blur, 2009).
template <class Place, class Visit>
void visit_moving(const LightView& view, const TileGrid& grid, const Vec3d& motion, const Place& place,
                  const Visit& visit) {
    const int across = grid.nx / grid.samples_x, down = grid.ny / grid.samples_y;
    const int parts = grid.samples_x * grid.samples_y;
    const TimedRay* rays = grid.timed.data();
    Placed from = place(Vec3d(0, 0, 0));
    for (int part = 0; part < parts; ++part, rays += static_cast<std::size_t>(across) * down) {
        const Placed to = place(motion * ((part + 1) / static_cast<double>(parts)));
        const PlaneBox box = swept(view, from, to);
        from = to;
        if (box.empty()) continue;
        const double x_low = grid.cells_x(box.x_low) - margin, x_high = grid.cells_x(box.x_high) + margin;
        const double y_low = grid.cells_y(box.y_low) - margin, y_high = grid.cells_y(box.y_high) + margin;
        if (x_high < 0.0 || y_high < 0.0 || x_low > grid.nx || y_low > grid.ny) continue;
        const int i_low = grid.column(x_low) / grid.samples_x, i_high = grid.column(x_high) / grid.samples_x;
        const int j_low = grid.row(y_low) / grid.samples_y, j_high = grid.row(y_high) / grid.samples_y;
        for (int j = j_low; j <= j_high; ++j)
            for (int i = i_low; i <= i_high; ++i) {
                const TimedRay& ray = rays[static_cast<std::size_t>(j) * across + i];
                visit(ray, motion * ray.time);
            }
    }
}

}  // namespace shadowbench::rays
