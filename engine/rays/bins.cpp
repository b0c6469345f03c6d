#include "rays/bins.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel.h"

namespace shadowbench::rays {

void add_sphere(const LightView& view, const Vec3d& c, double radius, PlaneBox& box) {
    if (!view.perspective) {
        box.add(c.x - radius, c.y - radius);
        box.add(c.x + radius, c.y + radius);
        return;
    }
    const double front = c.z - radius, back = c.z + radius;
    if (back <= view.z_near) return;
    if (front <= 0.25 * view.z_near) return add_across_near(view, {&c, 1}, radius, box);
    // The slopes of the box around the sphere: each extreme is at a corner.
    for (const double per_z : {1.0 / front, 1.0 / back}) {
        box.add((c.x - radius) * per_z, (c.y - radius) * per_z);
        box.add((c.x + radius) * per_z, (c.y + radius) * per_z);
    }
}

void add_hair(const LightView& view, const Vec3d& a, double radius_a, const Vec3d& b, double radius_b, PlaneBox& box) {
    if (view.perspective && std::min(a.z - radius_a, b.z - radius_b) <= view.z_near) {
        const Vec3d ends[] = {a, b};
        return add_across_near(view, ends, std::max(radius_a, radius_b), box);
    }
    add_sphere(view, a, radius_a, box);
    add_sphere(view, b, radius_b, box);
}

// The hull of cubes around the points, cut at the near plane: slopes are extreme at the corners of what is left, which
// are corners of cubes, and where an edge between like corners of two cubes meets the near plane.
void add_across_near(const LightView& view, std::span<const Vec3d> points, double radius, PlaneBox& box) {
    const double near = view.z_near;
    double largest = 0.0;
    for (const Vec3d& p : points) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    const double reach = radius + 1e-12 * largest;  // outweighs rounding
    const auto add_square = [&](const Vec3d& middle, double z) {
        box.add((middle.x - reach) / z, (middle.y - reach) / z);
        box.add((middle.x + reach) / z, (middle.y + reach) / z);
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3d& a = points[i];
        for (const double z : {a.z - reach, a.z + reach})
            if (z > near) add_square(a, z);
        for (std::size_t j = i; j < points.size(); ++j) {
            const Vec3d& b = points[j];
            if (std::max(a.z, b.z) < near - reach || std::min(a.z, b.z) > near + reach) continue;
            for (const double side : {-1.0, 1.0}) {
                const double u = a.z != b.z ? (near + side * reach - a.z) / (b.z - a.z) : side;
                add_square(a + (b - a) * std::clamp(u, 0.0, 1.0), near);
            }
        }
    }
}

void add_triangle(const LightView& view, const Vec3d& a, const Vec3d& b, const Vec3d& c, PlaneBox& box) {
    const Vec3d* v[3] = {&a, &b, &c};
    for (int i = 0; i < 3; ++i) {
        const Vec3d& p = *v[i];
        if (!view.perspective) {
            box.add(p.x, p.y);
            continue;
        }
        if (p.z > view.z_near) box.add(p.x / p.z, p.y / p.z);
        const Vec3d& q = *v[(i + 1) % 3];
        if ((p.z > view.z_near) != (q.z > view.z_near)) {  // the edge crosses the near plane
            const double u = (view.z_near - p.z) / (q.z - p.z);
            box.add((p.x + u * (q.x - p.x)) / view.z_near, (p.y + u * (q.y - p.y)) / view.z_near);
        }
    }
}

constexpr double max_entries = 0x1p30;  // 4 GiB

Bins make_bins(const LightView& view, const MapLayout& layout, std::size_t primitives,
               const std::function<PlaneBox(std::size_t)>& bounds) {
    struct TileRange {
        int x0 = 0, y0 = 0, x1 = -1, y1 = -1;  // inclusive
    };
    std::vector<TileRange> ranges(primitives);
    const double tile_x = view.pixel.x * layout.tile_width, tile_y = view.pixel.y * layout.tile_height;
    const auto tile_of = [](double place, int tiles) {
        return place <= 0.0 ? 0 : place >= tiles ? tiles - 1 : static_cast<int>(place);
    };
    constexpr std::size_t chunk = 4096;
    base::parallel_for((primitives + chunk - 1) / chunk, [&](std::size_t block) {
        for (std::size_t i = block * chunk; i < std::min(primitives, (block + 1) * chunk); ++i) {
            PlaneBox box = bounds(i);
            if (box.empty()) continue;
            // A hundredth of a sample cell on every side outweighs any rounding of the bounds.
            const double ex = (layout.apron + 0.01 / layout.samples_x) * view.pixel.x;
            const double ey = (layout.apron + 0.01 / layout.samples_y) * view.pixel.y;
            const double x0 = (box.x_low - ex - view.lower.x) / tile_x, x1 = (box.x_high + ex - view.lower.x) / tile_x;
            const double y0 = (box.y_low - ey - view.lower.y) / tile_y, y1 = (box.y_high + ey - view.lower.y) / tile_y;
            if (x1 < 0 || y1 < 0 || x0 > layout.tiles_x() || y0 > layout.tiles_y()) continue;
            ranges[i] = {tile_of(x0, layout.tiles_x()), tile_of(y0, layout.tiles_y()), tile_of(x1, layout.tiles_x()),
                         tile_of(y1, layout.tiles_y())};
        }
    });

    double entries = 0.0;
    for (const TileRange& r : ranges) entries += (r.x1 - r.x0 + 1.0) * (r.y1 - r.y0 + 1.0);
    if (entries > max_entries)
        throw base::Error(base::ErrorCode::bad_input, "/rays",
                          fmt::format("an object's {} primitives touch {:.3g} tiles of the map in all; the limit is "
                                      "{:.3g}: make the map, the primitives or their motion smaller",
                                      primitives, entries, max_entries));

    Bins bins;
    bins.begin.assign(layout.tiles() + 1, 0);
    for (const TileRange& r : ranges)
        for (int y = r.y0; y <= r.y1; ++y)
            for (int x = r.x0; x <= r.x1; ++x) ++bins.begin[y * layout.tiles_x() + x + 1];
    for (int t = 0; t < layout.tiles(); ++t) bins.begin[t + 1] += bins.begin[t];
    bins.primitives.resize(bins.begin.back());
    std::vector<std::uint64_t> next(bins.begin.begin(), bins.begin.end() - 1);
    for (std::size_t i = 0; i < primitives; ++i) {
        const TileRange& r = ranges[i];
        for (int y = r.y0; y <= r.y1; ++y)
            for (int x = r.x0; x <= r.x1; ++x)
                bins.primitives[next[y * layout.tiles_x() + x]++] = static_cast<std::uint32_t>(i);
    }
    return bins;
}

}  // namespace shadowbench::rays
