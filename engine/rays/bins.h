// Finds the primitives that may touch each tile.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "base/vec.h"
#include "rays/light_rays.h"
#include "rays/light_view.h"

namespace shadowbench::rays {

// Bounds on the view plane; empty until add() is called.
struct PlaneBox {
    double x_low = infinity, y_low = infinity, x_high = -infinity, y_high = -infinity;

    bool empty() const { return x_low > x_high; }
    void add(double x, double y) {
        x_low = std::min(x_low, x);
        x_high = std::max(x_high, x);
        y_low = std::min(y_low, y);
        y_high = std::max(y_high, y);
    }
    void add(const PlaneBox& box) {
        if (box.empty()) return;
        add(box.x_low, box.y_low);
        add(box.x_high, box.y_high);
    }

private:
    static constexpr double infinity = std::numeric_limits<double>::infinity();
};

// Adds the bounds of what a ray sees of a sphere (surface or not), a segment of hair with these half-widths at its
// ends, or a triangle. Parts at z <= z_near are left out.
void add_sphere(const LightView& view, const Vec3d& centre, double radius, PlaneBox& box);
void add_hair(const LightView& view, const Vec3d& a, double radius_a, const Vec3d& b, double radius_b, PlaneBox& box);
void add_triangle(const LightView& view, const Vec3d& a, const Vec3d& b, const Vec3d& c, PlaneBox& box);

// The same for all that lies within `radius` of the hull of the points, of which parts may lie before the near plane of
// a view in perspective: beside the light its slopes are large, so most tiles do not meet it.
void add_across_near(const LightView& view, std::span<const Vec3d> points, double radius, PlaneBox& box);

// One list of primitives for each tile.
struct Bins {
    std::vector<std::uint64_t> begin;  // tiles + 1
    std::vector<std::uint32_t> primitives;

    std::span<const std::uint32_t> of(int tile) const {
        return {primitives.data() + begin[tile], primitives.data() + begin[tile + 1]};
    }
    std::size_t bytes() const {
        return begin.capacity() * sizeof(std::uint64_t) + primitives.capacity() * sizeof(std::uint32_t);
    }
};

// `bounds(i)` returns the view-plane bounds of primitive i; it is called from several threads. The primitives of a tile
// keep their order. Throws Error{bad_input} if the lists would not fit in memory.
Bins make_bins(const LightView& view, const MapLayout& layout, std::size_t primitives,
               const std::function<PlaneBox(std::size_t)>& bounds);

}  // namespace shadowbench::rays
