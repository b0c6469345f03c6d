// The cells of a map, and those that a lookup's footprint covers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "rays/light_rays.h"
#include "techniques/cell_grid.h"
#include "techniques/technique.h"

namespace shadowbench::techniques {

// The parameter that chooses between Cells::sample and Cells::centre, for techniques whose functions are of one ray.
inline const Parameter cells_parameter{
    "cells",
    ParameterKind::choice,
    "one stored function per sample (which makes the map that many times larger), or one per pixel, of the ray in "
    "the middle of the pixel",
    0,
    0,
    0,
    "sample",
    {"sample", "centre"}};
// The same for techniques that can store the mean of a pixel's rays: it is filtered before it is stored, as in a deep
// shadow map.
inline const Parameter averaged_cells_parameter{
    .name = "cells",
    .kind = ParameterKind::choice,
    .doc =
        "one stored function per pixel, of the mean visibility of all its rays; one per sample (which makes the map "
        "that many times larger); or one per pixel, of the ray in the middle of the pixel",
    .standard_word = "pixel",
    .words = {"pixel", "sample", "centre"}};
inline Cells read_cells(const ParameterValues& values) {
    const std::string& word = values.word("cells");
    return word == "sample" ? Cells::sample : word == "pixel" ? Cells::pixel : Cells::centre;
}

// Calls visit(cell index in the grid, ray number in the tile) for every cell that a tile fills, by rows. With
// Cells::pixel the tile has the rays of MeanRays, one a pixel.
template <class Visit>
void for_each_cell(const rays::MapLayout& layout, const CellGrid& grid, Cells cells, const rays::LightRays& tile,
                   const Visit& visit) {
    const int nx = cells == Cells::sample ? layout.samples_x : 1, ny = cells == Cells::sample ? layout.samples_y : 1;
    for (int y = 0; y < tile.height * ny; ++y)
        for (int x = 0; x < tile.width * nx; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y / ny) * tile.width + x / nx;
            const int sample = cells == Cells::sample ? (y % ny) * nx + x % nx
                               : cells == Cells::pixel
                                   ? 0
                                   : (layout.samples_y / 2) * layout.samples_x + layout.samples_x / 2;
            visit(grid.index(tile.x0 * nx + x, tile.y0 * ny + y), pixel * tile.samples + sample);
        }
}

// The width of a query's filter; 0 if it is negative or NaN.
inline float width_of(const Query& q) {
    return std::max(0.0f, q.width);  // in this order, since a comparison with NaN is false
}

// A rectangle of cells [x0, x1) x [y0, y1).
struct CellRange {
    int x0 = 0, x1 = 0, y0 = 0, y1 = 0;
};

// Along one side of a map: the cells [begin, end) that a footprint reaches, at least one, and how much of each it
// covers. In double, since the covered part of a border cell is a small difference of large positions.
struct Stretch {
    int begin = 0, end = 1;
    double first = 1.0, last = 1.0;  // covered part of cells `begin` and `end` - 1, in cells

    double weight(int cell) const { return cell == begin ? first : cell + 1 == end ? last : 1.0; }
};

// The cells of a footprint `width` cells wide around `centre`, cut to the map's [0, filled), in which the centre must
// lie; `filled` may end inside its last cell. The cell of the centre if the footprint is too narrow to cover anything.
inline Stretch stretch(double centre, double width, double filled) {
    const double low = std::max(centre - 0.5 * width, 0.0), high = std::min(centre + 0.5 * width, filled);
    const int nearest = static_cast<int>(centre);
    if (!(low < high)) return {nearest, nearest + 1, 1.0, 1.0};
    const int begin = static_cast<int>(low), whole = static_cast<int>(high);
    const int end = whole < high ? whole + 1 : whole;
    if (end - begin == 1) return {begin, end, high - low, high - low};
    return {begin, end, begin + 1 - low, high - (end - 1)};
}

// Calls visit(x, y, weight) for the cells of two sides, row after row.
template <class Side, class Visit>
void for_each_of(const Side& across, const Side& down, const Visit& visit) {
    for (int y = down.begin; y < down.end; ++y) {
        const double wy = down.weight(y);
        for (int x = across.begin; x < across.end; ++x) visit(x, y, wy * across.weight(x));
    }
}

// Visits the cells that the footprint of a query covers, each weighted by the part of its area that is covered: the box
// filter of the reference (the rays within half the footprint's width, inside the map), for functions that each stand
// for a cell. The query must lie in the map.
template <class Visit>
void for_each_covered(const CellGrid& grid, const Query& q, const Visit& visit) {
    const double width = width_of(q);
    const Stretch across = stretch(static_cast<double>(q.x) * grid.per_pixel_x, width * grid.per_pixel_x, grid.width);
    const Stretch down = stretch(static_cast<double>(q.y) * grid.per_pixel_y, width * grid.per_pixel_y, grid.height);
    for_each_of(across, down, visit);
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
