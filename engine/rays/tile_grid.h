// The sample rays of one tile, on the light's view plane.
#pragma once

#include <cstdint>
#include <vector>

#include "rays/light_rays.h"
#include "rays/light_view.h"

namespace shadowbench::rays {

constexpr double margin = 1e-3;  // part of a sample cell, around all bounds: exceeds their rounding

// A ray of a moving layout.
struct TimedRay {
    double x, y;  // on the view plane
    double time;  // in the shutter, [0, 1)
    std::uint32_t ray;
};

struct TileGrid {
    int i0 = 0, j0 = 0;                     // the tile's first sample cell in the map
    int nx = 0, ny = 0;                     // sample cells
    int samples_x = 1, samples_y = 1;       // sample cells per pixel
    double per_cell_x = 1, per_cell_y = 1;  // cells per length on the view plane
    double plane_x = 0, plane_y = 0;        // view-plane position of the tile's corner
    // Row after row: the view-plane position of each sample (world length, or slope in perspective), and the number of
    // the tile's ray in each column and row: ray = ray_row[j] + ray_column[i].
    std::vector<double> x, y;
    std::vector<std::uint32_t> ray_column, ray_row;
    std::vector<std::uint32_t> ray;  // the same for each sample
    // x and y in cells of this tile, for readers of four samples of a row: rows begin `cell_stride` apart, and NaNs
    // follow each.
    std::vector<float> cell_x, cell_y;
    std::size_t cell_stride = 0;
    // If asked for, the same rays by their time: for each of the samples() equal parts of the shutter, one ray of every
    // pixel, row after row of pixels. Otherwise empty.
    std::vector<TimedRay> timed;

    // A view-plane position in cells of this tile, and the nearest column and row of the tile to it.
    double cells_x(double place) const { return (place - plane_x) * per_cell_x; }
    double cells_y(double place) const { return (place - plane_y) * per_cell_y; }
    int column(double cell) const { return clamp_cell(cell, nx); }
    int row(double cell) const { return clamp_cell(cell, ny); }

private:
    static int clamp_cell(double cell, int count) {
        return cell <= 0.0 ? 0 : cell >= count ? count - 1 : static_cast<int>(cell);
    }
};

// `timed` is needed only if the tile meets something that moves.
TileGrid make_tile_grid(const LightView& view, const MapLayout& layout, const LightRays& tile, bool timed);

}  // namespace shadowbench::rays
