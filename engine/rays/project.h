// Projects primitives into the sample grid of a tile and tests exactly each sample that a primitive may cover. `Sink`
// is SurfaceHits or SegmentHits (hits.h). Internal to tile_projection.h, which chooses what is projected.
#pragma once

#include <algorithm>
#include <cmath>

#include "rays/bins.h"
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
