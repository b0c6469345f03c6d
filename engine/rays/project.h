// Projecting primitives into the sample grid of a tile: each sample that a primitive may cover is tested exactly.
// `Sink` is SurfaceHits or SegmentHits (hits.h). Internal to capture.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "rays/primitives.h"
#include "rays/tile_grid.h"

namespace shadowbench::rays {

// Places [low, high] of a line's x over rows y_low .. y_high, both widened by `reach`.
struct Span {
    double low, high;
};
inline Span line_span(double ax, double ay, double bx, double by, double y_low, double y_high, double reach) {
    double u0 = 0.0, u1 = 1.0;
    if (const double dy = by - ay; dy != 0.0) {
        const double inverse = 1.0 / dy;
        const double ua = (y_low - reach - ay) * inverse, ub = (y_high + reach - ay) * inverse;
        u0 = std::clamp(std::min(ua, ub), 0.0, 1.0);
        u1 = std::clamp(std::max(ua, ub), 0.0, 1.0);
    }
    const double x0 = ax + (bx - ax) * u0, x1 = ax + (bx - ax) * u1;
    return {std::min(x0, x1) - reach, std::max(x0, x1) + reach};
}

template <bool perspective, class Sink>
void project_hair(const HairSegment& s, const TileGrid& grid, double z_near, const float* transmittance, Sink& sink) {
    // The axis on the view plane, and how far from it the ribbon can reach in x or y.
    double ax = s.a.x, ay = s.a.y, bx = s.b.x, by = s.b.y, reach = std::max(s.radius_a, s.radius_b);
    if constexpr (perspective) {
        const auto reach_of = [](double place, double z, double r) {
            return (std::abs(place) + r) / (z - r) - std::abs(place) / z;  // slopes of the box around a sphere
        };
        const double front = std::min(s.a.z - s.radius_a, s.b.z - s.radius_b);
        if (front <= 0.25 * z_near) {
            if (std::max(s.a.z, s.b.z) <= z_near) return;
            ax = bx = grid.plane_x;  // around the light: try every sample
            ay = by = grid.plane_y;
            reach = std::numeric_limits<double>::infinity();
        } else {
            reach = std::max({reach_of(ax, s.a.z, s.radius_a), reach_of(ay, s.a.z, s.radius_a),
                              reach_of(bx, s.b.z, s.radius_b), reach_of(by, s.b.z, s.radius_b)});
            ax /= s.a.z;
            ay /= s.a.z;
            bx /= s.b.z;
            by /= s.b.z;
        }
    }
    reach += 1e-9 * (std::abs(ax) + std::abs(ay) + std::abs(bx) + std::abs(by)) +
             1e-3 * std::min(grid.cell_x, grid.cell_y);  // outweighs rounding of the bounds
    const int j_low = grid.row(std::min(ay, by) - reach), j_high = grid.row(std::max(ay, by) + reach);
    for (int j = j_low; j <= j_high; ++j) {
        const double y = grid.row_start(j);
        const Span span = reach == std::numeric_limits<double>::infinity()
                              ? Span{-reach, reach}
                              : line_span(ax, ay, bx, by, y, y + grid.cell_y, reach);
        const int i_high = grid.column(span.high);
        for (int i = grid.column(span.low); i <= i_high; ++i) {
            const std::size_t sample = static_cast<std::size_t>(j) * grid.nx + i;
            const RayMetric<perspective> ray(grid.x[sample], grid.y[sample]);
            double z;
            if (cross_hair(s, ray, z) && z > z_near) sink.surface(grid.ray_row[j] + grid.ray_column[i], z, transmittance);
        }
    }
}

// `shade(weights)` gives the transmittances of a crossing, or null where there is nothing.
template <class Sink, class Shade>
void project_triangle(const TriangleSetup& t, double x_low, double x_high, double y_low, double y_high,
                      const TileGrid& grid, double z_near, const Shade& shade, Sink& sink) {
    const int j_low = grid.row(y_low), j_high = grid.row(y_high);
    for (int j = j_low; j <= j_high; ++j) {
        const int i_high = grid.column(x_high);
        for (int i = grid.column(x_low); i <= i_high; ++i) {
            const std::size_t sample = static_cast<std::size_t>(j) * grid.nx + i;
            double z, weight[3];
            if (!cross_triangle(t, grid.x[sample], grid.y[sample], z, weight) || !(z > z_near)) continue;
            if (const float* transmittance = shade(weight))
                sink.surface(grid.ray_row[j] + grid.ray_column[i], z, transmittance);
        }
    }
}

// Calls visit(ray, x, y) for every sample inside the view-plane bounds.
template <class Visit>
void visit_samples(double x_low, double x_high, double y_low, double y_high, const TileGrid& grid, const Visit& visit) {
    const int i_low = grid.column(x_low), i_high = grid.column(x_high);
    for (int j = grid.row(y_low), j_high = grid.row(y_high); j <= j_high; ++j)
        for (int i = i_low; i <= i_high; ++i) {
            const std::size_t sample = static_cast<std::size_t>(j) * grid.nx + i;
            visit(grid.ray_row[j] + grid.ray_column[i], grid.x[sample], grid.y[sample]);
        }
}

}  // namespace shadowbench::rays
