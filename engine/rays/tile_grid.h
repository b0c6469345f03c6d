// The sample rays of one tile, on the light's view plane.
#pragma once

#include <cstdint>
#include <vector>

#include "rays/light_rays.h"
#include "rays/light_view.h"

namespace shadowbench::rays {

// View-plane bounds in sample cells of the map, [low, high) in both axes; empty when low >= high.
struct CellBounds {
    int x_low = 0, y_low = 0, x_high = 0, y_high = 0;
};

struct TileGrid {
    int i0 = 0, j0 = 0;  // the tile's first sample cell in the map
    int nx = 0, ny = 0;  // sample cells
    double cell_x, cell_y;    // size of a cell on the view plane
    double plane_x, plane_y;  // view-plane place of the map's corner
    // Row after row: view-plane position of each sample (world length, or slope in perspective), and the tile's ray
    // number of each column and row: ray = ray_row[j] + ray_column[i].
    std::vector<double> x, y;
    std::vector<std::uint32_t> ray_column, ray_row;

    // Cells of this tile that a map-wide span [low, high] of view-plane places can meet, clamped, tile-relative.
    int column(double place) const { return clamp_cell((place - plane_x) / cell_x - i0, nx); }
    int row(double place) const { return clamp_cell((place - plane_y) / cell_y - j0, ny); }
    double row_start(int j) const { return plane_y + (j0 + j) * cell_y; }

private:
    static int clamp_cell(double cell, int count) {
        return cell <= 0.0 ? 0 : cell >= count ? count - 1 : static_cast<int>(cell);
    }
};

TileGrid make_tile_grid(const LightView& view, const MapLayout& layout, const LightRays& tile);

}  // namespace shadowbench::rays
