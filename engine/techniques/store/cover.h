// The cells that a block of footprints covers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "techniques/cell_grid.h"
#include "techniques/store/cells.h"
#include "techniques/technique.h"

namespace shadowbench::techniques {

// The most queries of a block.
inline constexpr std::size_t block_queries = 32;

// Along one side of the map, for each query of a block: see Stretch.
struct BlockSide {
    alignas(64) std::array<std::int32_t, block_queries> begin, end;
    alignas(64) std::array<double, block_queries> first, last;
    std::int32_t longest = 0;  // the most cells of a query

    Stretch operator[](std::size_t k) const { return {begin[k], end[k], first[k], last[k]}; }
};

// For each query of a block: whether it lies in the map, and the cells of its footprint, as for_each_covered() visits
// them; for a query outside the map, those of some other place.
struct Cover {
    std::array<bool, block_queries> inside;
    BlockSide across, down;
    float widest = 0.0f;  // the largest width of a query, in pixels
};

// Cells that the queries of a block read, in slots: number s * block_queries + k is the s-th of query k.
inline constexpr std::size_t cell_slots = 4;
using CellSlots = std::array<std::size_t, cell_slots * block_queries>;

// At most block_queries.
void cover(const CellGrid& grid, std::span<const Query> queries, Cover& out);
// The same for the cells that the queries lie in, whatever their width: one for each.
void cover_nearest(const CellGrid& grid, std::span<const Query> queries, Cover& out);

// The indices of footprints of at most 2 x 2 cells, row after row; a narrower one repeats cells. `width`: of the map.
void four_cells(const Cover& cover, int width, CellSlots& cells);

}  // namespace shadowbench::techniques
