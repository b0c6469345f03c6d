// Projects primitives into the sample grid of a tile and tests exactly each sample that a primitive may cover. `Sink`
// is SurfaceHits or SegmentHits (hits.h). Internal to tile_projection.h, which chooses what is projected.
#pragma once

#include <algorithm>
#include <cmath>

#include "rays/bins.h"
#include "rays/light_view.h"
#include "rays/primitives.h"
#include "rays/tile_grid.h"

namespace shadowbench::rays {

// Calls visit(ray, x, y) for every sample inside the view-plane bounds.
template <class Visit>
void visit_samples(const PlaneBox& box, const TileGrid& grid, const Visit& visit) {
    const int i_low = grid.column(grid.cells_x(box.x_low) - margin);
    const int i_high = grid.column(grid.cells_x(box.x_high) + margin);
    const int j_low = grid.row(grid.cells_y(box.y_low) - margin), j_high = grid.row(grid.cells_y(box.y_high) + margin);
    for (int j = j_low; j <= j_high; ++j)
        for (int i = i_low; i <= i_high; ++i) {
            const std::size_t sample = static_cast<std::size_t>(j) * grid.nx + i;
            visit(grid.ray_row[j] + grid.ray_column[i], grid.x[sample], grid.y[sample]);
        }
}

template <bool perspective, class Sink>
void project_hair(const HairSegment& s, const TileGrid& grid, const LightView& view, const float* transmittance,
                  Sink& sink) {
    const auto test = [&](std::uint32_t ray, double x, double y) {
        double z;
        if (cross_hair(s, RayMetric<perspective>(x, y), z) && z > view.z_near) sink.surface(ray, z, transmittance);
    };
    // The axis on the view plane, and how far the ribbon can reach from it in x or y.
    double ax = s.a.x, ay = s.a.y, bx = s.b.x, by = s.b.y, reach = std::max(s.radius_a, s.radius_b);
    if constexpr (perspective) {
        const auto reach_of = [](double place, double z, double r) {
            return (std::abs(place) + r) / (z - r) - std::abs(place) / z;  // slopes of the box around a sphere
        };
        if (std::min(s.a.z - s.radius_a, s.b.z - s.radius_b) <= 0.25 * view.z_near) {  // slopes grow without bound
            PlaneBox box;
            add_hair(view, base::Vec3d(s.a), s.radius_a, base::Vec3d(s.b), s.radius_b, box);
            if (!box.empty()) visit_samples(box, grid, test);
            return;
        }
        reach = std::max({reach_of(ax, s.a.z, s.radius_a), reach_of(ay, s.a.z, s.radius_a),
                          reach_of(bx, s.b.z, s.radius_b), reach_of(by, s.b.z, s.radius_b)});
        const double inverse_a = 1.0 / s.a.z, inverse_b = 1.0 / s.b.z;
        ax *= inverse_a;
        ay *= inverse_a;
        bx *= inverse_b;
        by *= inverse_b;
    }
    // The same in cells of this tile.
    ax = grid.cells_x(ax);
    bx = grid.cells_x(bx);
    ay = grid.cells_y(ay);
    by = grid.cells_y(by);
    const double reach_x = reach * grid.per_cell_x + margin, reach_y = reach * grid.per_cell_y + margin;
    const double inverse_dy = by != ay ? 1.0 / (by - ay) : 0.0;
    const int j_low = grid.row(std::min(ay, by) - reach_y), j_high = grid.row(std::max(ay, by) + reach_y);
    for (int j = j_low; j <= j_high; ++j) {
        double u0 = 0.0, u1 = 1.0;  // where the axis crosses the rows within reach of this one
        if (inverse_dy != 0.0) {
            const double ua = (j - reach_y - ay) * inverse_dy, ub = (j + 1 + reach_y - ay) * inverse_dy;
            u0 = std::min(std::max(std::min(ua, ub), 0.0), 1.0);
            u1 = std::min(std::max(std::max(ua, ub), 0.0), 1.0);
        }
        const double x0 = ax + (bx - ax) * u0, x1 = ax + (bx - ax) * u1;
        const int i_low = grid.column(std::min(x0, x1) - reach_x), i_high = grid.column(std::max(x0, x1) + reach_x);
        for (int i = i_low; i <= i_high; ++i) {
            const std::size_t sample = static_cast<std::size_t>(j) * grid.nx + i;
            test(grid.ray_row[j] + grid.ray_column[i], grid.x[sample], grid.y[sample]);
        }
    }
}

// `shade(weights)` returns the transmittances of a crossing, or null if the texture has a hole there.
template <class Sink, class Shade>
void project_triangle(const TriangleSetup& t, double x_low, double x_high, double y_low, double y_high,
                      const TileGrid& grid, double z_near, const Shade& shade, Sink& sink) {
    const int j_low = grid.row(grid.cells_y(y_low) - margin), j_high = grid.row(grid.cells_y(y_high) + margin);
    const int i_low = grid.column(grid.cells_x(x_low) - margin), i_high = grid.column(grid.cells_x(x_high) + margin);
    for (int j = j_low; j <= j_high; ++j) {
        for (int i = i_low; i <= i_high; ++i) {
            const std::size_t sample = static_cast<std::size_t>(j) * grid.nx + i;
            double z, weight[3];
            if (!cross_triangle(t, grid.x[sample], grid.y[sample], z, weight) || !(z > z_near)) continue;
            if (const float* transmittance = shade(weight))
                sink.surface(grid.ray_row[j] + grid.ray_column[i], z, transmittance);
        }
    }
}

}  // namespace shadowbench::rays
