#include "rays/tile_grid.h"

#include <limits>

#include "rays/pixel_positions.h"

namespace shadowbench::rays {
namespace {

void add_cells(TileGrid& grid) {
    grid.ray.resize(grid.x.size());
    grid.cell_stride = static_cast<std::size_t>(grid.nx) + 3;
    grid.cell_x.assign(grid.cell_stride * grid.ny, std::numeric_limits<float>::quiet_NaN());
    grid.cell_y.assign(grid.cell_stride * grid.ny, std::numeric_limits<float>::quiet_NaN());
    std::size_t s = 0;
    for (int j = 0; j < grid.ny; ++j)
        for (int i = 0; i < grid.nx; ++i, ++s) {
            const std::size_t at = j * grid.cell_stride + i;
            grid.cell_x[at] = static_cast<float>(grid.cells_x(grid.x[s]));
            grid.cell_y[at] = static_cast<float>(grid.cells_y(grid.y[s]));
            grid.ray[s] = grid.ray_row[j] + grid.ray_column[i];
        }
}

void add_times(const MapLayout& layout, TileGrid& grid) {
    const std::size_t across = static_cast<std::size_t>(grid.nx / layout.samples_x);
    const std::size_t pixels = across * static_cast<std::size_t>(grid.ny / layout.samples_y);
    grid.timed.resize(grid.x.size());
    std::size_t s = 0;
    for (int j = 0; j < grid.ny; ++j)
        for (int i = 0; i < grid.nx; ++i, ++s) {
            const double time = sample_time(layout, grid.i0 + i, grid.j0 + j);
            const std::size_t part = static_cast<std::size_t>(time * layout.samples());
            const std::size_t pixel = j / layout.samples_y * across + i / layout.samples_x;
            grid.timed[part * pixels + pixel] = {grid.x[s], grid.y[s], time, grid.ray_row[j] + grid.ray_column[i]};
        }
}

}  // namespace

TileGrid make_tile_grid(const LightView& view, const MapLayout& layout, const LightRays& tile, bool timed) {
    TileGrid grid;
    grid.i0 = tile.x0 * layout.samples_x;
    grid.j0 = tile.y0 * layout.samples_y;
    grid.nx = tile.width * layout.samples_x;
    grid.ny = tile.height * layout.samples_y;
    grid.samples_x = layout.samples_x;
    grid.samples_y = layout.samples_y;
    grid.per_cell_x = layout.samples_x / view.pixel.x;
    grid.per_cell_y = layout.samples_y / view.pixel.y;
    grid.plane_x = view.lower.x + tile.x0 * view.pixel.x;
    grid.plane_y = view.lower.y + tile.y0 * view.pixel.y;
    const std::size_t count = static_cast<std::size_t>(grid.nx) * grid.ny;
    grid.x.resize(count);
    grid.y.resize(count);
    std::vector<SamplePosition> positions;
    for (int y = 0; y < tile.height; ++y)
        for (int x = 0; x < tile.width; ++x) {
            pixel_positions(layout, tile.x0 + x, tile.y0 + y, positions);
            std::size_t ray = 0;
            for (int j = y * layout.samples_y; j < (y + 1) * layout.samples_y; ++j)
                for (int i = x * layout.samples_x; i < (x + 1) * layout.samples_x; ++i, ++ray) {
                    const std::size_t s = static_cast<std::size_t>(j) * grid.nx + i;
                    grid.x[s] = view.lower.x + positions[ray].x * view.pixel.x;
                    grid.y[s] = view.lower.y + positions[ray].y * view.pixel.y;
                }
        }
    grid.ray_column.resize(grid.nx);
    for (int i = 0; i < grid.nx; ++i)
        grid.ray_column[i] = (i / layout.samples_x) * layout.samples() + i % layout.samples_x;
    grid.ray_row.resize(grid.ny);
    for (int j = 0; j < grid.ny; ++j)
        grid.ray_row[j] =
            (j / layout.samples_y) * tile.width * layout.samples() + (j % layout.samples_y) * layout.samples_x;
    add_cells(grid);
    if (timed) add_times(layout, grid);
    return grid;
}

}  // namespace shadowbench::rays
