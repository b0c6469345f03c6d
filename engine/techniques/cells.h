// The cells of a map, and which of them a lookup's footprint covers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "rays/light_rays.h"
#include "techniques/technique.h"

namespace shadowbench::techniques {

// A map's cells: one a sample of the layout, or one a pixel.
struct CellGrid {
    int width = 0, height = 0;
    float per_pixel_x = 1, per_pixel_y = 1;

    std::size_t count() const { return static_cast<std::size_t>(width) * height; }
    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
    // Cell of a map position in pixels; false outside the map.
    bool find(float px, float py, int& x, int& y) const {
        const float fx = px * per_pixel_x, fy = py * per_pixel_y;
        if (!(fx >= 0.0f && fy >= 0.0f && fx < static_cast<float>(width) && fy < static_cast<float>(height)))
            return false;
        x = static_cast<int>(fx);
        y = static_cast<int>(fy);
        return true;
    }
};

inline CellGrid make_cells(const rays::MapLayout& layout, Cells cells) {
    if (cells == Cells::sample)
        return {layout.width * layout.samples_x, layout.height * layout.samples_y, static_cast<float>(layout.samples_x),
                static_cast<float>(layout.samples_y)};
    return {layout.width, layout.height, 1.0f, 1.0f};
}

// The parameter that chooses between Cells::sample and Cells::centre, for techniques whose functions are of one ray.
inline const Parameter cells_parameter{
    "cells",
    ParameterKind::choice,
    "one stored function a sample (the map is as much larger), or one a pixel, of the "
    "ray in the middle of the pixel",
    0,
    0,
    0,
    "sample",
    {"sample", "centre"}};
// The same for functions that can be averaged over rays.
inline const Parameter averaged_cells_parameter{
    .name = "cells",
    .kind = ParameterKind::choice,
    .doc =
        "one stored function a pixel, of all its rays; one a sample (the map is as much larger); or one a pixel, of "
        "the ray in the middle of the pixel",
    .standard_word = "pixel",
    .words = {"pixel", "sample", "centre"}};
inline Cells read_cells(const ParameterValues& values) {
    const std::string& word = values.word("cells");
    return word == "sample" ? Cells::sample : word == "pixel" ? Cells::pixel : Cells::centre;
}

// Calls visit(cell index in the grid, ray number in the tile) for every cell that a tile fills, by rows.
template <class Visit>
void for_each_cell(const rays::MapLayout& layout, const CellGrid& grid, Cells cells, const rays::LightRays& tile,
                   const Visit& visit) {
    const int nx = cells == Cells::sample ? layout.samples_x : 1, ny = cells == Cells::sample ? layout.samples_y : 1;
    for (int y = 0; y < tile.height * ny; ++y)
        for (int x = 0; x < tile.width * nx; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y / ny) * tile.width + x / nx;
            const int sample = cells == Cells::sample
                                   ? (y % ny) * nx + x % nx
                                   : (layout.samples_y / 2) * layout.samples_x + layout.samples_x / 2;
            visit(grid.index(tile.x0 * nx + x, tile.y0 * ny + y), pixel * tile.samples + sample);
        }
}

// The width of a query's filter: 0 for what is no width.
inline float width_of(const Query& q) {
    return std::max(0.0f, q.width);  // in this order: a comparison with what is not a number is false
}

// Cells [x0, x1) x [y0, y1) whose centres lie within half the footprint's width of (px, py): the box filter of a lookup
// (Lokovic and Veach 2000, section 3.4, with f a box). At least the nearest cell; clipped to the map; empty outside it.
struct CellRange {
    int x0 = 0, x1 = 0, y0 = 0, y1 = 0;
};
inline CellRange footprint(const CellGrid& grid, const Query& q) {
    int cx, cy;
    if (!grid.find(q.x, q.y, cx, cy)) return {};
    // Cut to the map while they are floats, which hold any width; what is left is not negative, so that an integer cuts
    // off its fraction as floor() would.
    const auto range = [](float centre, float half, int nearest, int count, int& low, int& high) {
        low = static_cast<int>(std::max(centre - half + 0.5f, 0.0f));
        high = std::min(static_cast<int>(std::min(centre + half + 0.5f, static_cast<float>(count))), count);
        if (low >= high) {
            low = nearest;
            high = nearest + 1;
        }
    };
    const float half = 0.5f * width_of(q);
    CellRange r;
    range(q.x * grid.per_pixel_x, half * grid.per_pixel_x, cx, grid.width, r.x0, r.x1);
    range(q.y * grid.per_pixel_y, half * grid.per_pixel_y, cy, grid.height, r.y0, r.y1);
    return r;
}

// Appends an address in each 64-byte line of [first, first + bytes); every address lies in that memory.
inline void touch_lines(const void* first, std::size_t bytes, std::vector<const void*>& lines) {
    const auto begin = reinterpret_cast<std::uintptr_t>(first), end = begin + bytes;
    for (std::uintptr_t at = begin; at < end; at = (at / 64 + 1) * 64)
        lines.push_back(reinterpret_cast<const void*>(at));
}

// Each line counts once in a lookup, however often it is read: drops further addresses of a line from `first` on.
inline void keep_unique(std::vector<const void*>& lines, std::size_t first) {
    const auto same_line = [](const void* a, const void* b) {
        return reinterpret_cast<std::uintptr_t>(a) / 64 == reinterpret_cast<std::uintptr_t>(b) / 64;
    };
    const auto begin = lines.begin() + static_cast<std::ptrdiff_t>(first);
    std::sort(begin, lines.end());
    lines.erase(std::unique(begin, lines.end(), same_line), lines.end());
}

}  // namespace shadowbench::techniques
