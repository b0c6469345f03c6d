#include "techniques/store/cover.h"

#include <algorithm>

#include "techniques/store/simd_path.h"

namespace shadowbench::techniques {
namespace {

struct Places {
    alignas(64) std::array<float, block_queries> x, y, width;
};

// stretch() for every place. A footprint that covers nothing becomes the cell of its centre. No branches: the loops
// become vector instructions.
SHADOWBENCH_SIMD_LOOP inline void side_of(const float* places, const float* widths, float a_pixel, int cells,
                                           BlockSide& out) {
    alignas(64) std::array<double, block_queries> low, high, nearest, behind;
    const double filled = cells, per_pixel = a_pixel;
    for (std::size_t k = 0; k < block_queries; ++k) {
        nearest[k] = static_cast<double>(static_cast<std::int32_t>(places[k] * per_pixel));
        behind[k] = nearest[k] + 1.0;
    }
    for (std::size_t k = 0; k < block_queries; ++k) {
        const double centre = places[k] * per_pixel, half = 0.5 * (widths[k] * per_pixel);
        low[k] = std::max(centre - half, 0.0);
        high[k] = std::min(centre + half, filled);
    }
    for (std::size_t k = 0; k < block_queries; ++k) {
        const double begin = low[k], end = high[k], begin_else = nearest[k], end_else = behind[k];
        low[k] = begin < end ? begin : begin_else;
        high[k] = begin < end ? end : end_else;
    }
    for (std::size_t k = 0; k < block_queries; ++k) {
        const std::int32_t begin = static_cast<std::int32_t>(low[k]), whole = static_cast<std::int32_t>(high[k]);
        const double begin_place = begin, whole_place = whole;
        const std::int32_t end = whole + (whole_place < high[k] ? 1 : 0);
        const double second = begin_place + 1.0, last = static_cast<double>(end) - 1.0;
        out.begin[k] = begin;
        out.end[k] = end;
        out.first[k] = std::min(second, high[k]) - low[k];
        out.last[k] = high[k] - std::max(low[k], last);
    }
    out.longest = 0;
    for (std::size_t k = 0; k < block_queries; ++k) out.longest = std::max(out.longest, out.end[k] - out.begin[k]);
}

SHADOWBENCH_SIMD_LOOP inline void nearest_of(const float* places, float per_pixel, BlockSide& out) {
    for (std::size_t k = 0; k < block_queries; ++k) {
        out.begin[k] = static_cast<std::int32_t>(places[k] * per_pixel);
        out.end[k] = out.begin[k] + 1;
    }
}

// The places of the queries in the map; 0 for one outside.
void find_places(const CellGrid& grid, std::span<const Query> queries, Places& places,
                 std::array<bool, block_queries>& in_map) {
    const float width = static_cast<float>(grid.width), height = static_cast<float>(grid.height);
    std::size_t k = 0;
    for (const Query& q : queries) {
        const float x = q.x * grid.per_pixel_x, y = q.y * grid.per_pixel_y;
        const bool inside = (x >= 0.0f) & (y >= 0.0f) & (x < width) & (y < height);
        in_map[k] = inside;
        places.x[k] = inside ? q.x : 0.0f;
        places.y[k] = inside ? q.y : 0.0f;
        places.width[k++] = width_of(q);
    }
    for (; k < block_queries; ++k) {
        in_map[k] = false;
        places.x[k] = places.y[k] = places.width[k] = 0.0f;
    }
}

}  // namespace

void cover(const CellGrid& grid, std::span<const Query> queries, Cover& out) {
    Places places;
    find_places(grid, queries, places, out.inside);
    on_simd_path([&]() SHADOWBENCH_SIMD_LOOP {
        side_of(places.x.data(), places.width.data(), grid.per_pixel_x, grid.width, out.across);
        side_of(places.y.data(), places.width.data(), grid.per_pixel_y, grid.height, out.down);
    });
}

void cover_nearest(const CellGrid& grid, std::span<const Query> queries, Cover& out) {
    Places places;
    find_places(grid, queries, places, out.inside);
    for (BlockSide* side : {&out.across, &out.down}) {
        side->first.fill(1.0);
        side->last.fill(1.0);
        side->longest = 1;
    }
    on_simd_path([&]() SHADOWBENCH_SIMD_LOOP {
        nearest_of(places.x.data(), grid.per_pixel_x, out.across);
        nearest_of(places.y.data(), grid.per_pixel_y, out.down);
    });
}

}  // namespace shadowbench::techniques
