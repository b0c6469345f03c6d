#include "techniques/store/cover.h"

#include <algorithm>
#include <bit>

#include "base/simd_path.h"

namespace shadowbench::techniques {
namespace {

struct Places {
    alignas(64) std::array<float, block_queries> x, y, width;
};

// stretch() for every place. A footprint that covers nothing becomes the cell of its centre. No branches: the loops
// become vector instructions.
SHADOWBENCH_SIMD_LOOP inline void side_of(const float* places, const float* widths, float a_pixel, int cells,
                                          BlockSide& out) {
    alignas(64) std::array<double, block_queries> nearest, behind, from, to;
    const double filled = cells, per_pixel = a_pixel;
    for (std::size_t k = 0; k < block_queries; ++k) {
        nearest[k] = static_cast<double>(static_cast<std::int32_t>(places[k] * per_pixel));
        behind[k] = nearest[k] + 1.0;
    }
    for (std::size_t k = 0; k < block_queries; ++k) {
        const double centre = places[k] * per_pixel, half = 0.5 * (widths[k] * per_pixel);
        const double low = std::max(centre - half, 0.0), high = std::min(centre + half, filled);
        const double begin_else = nearest[k], end_else = behind[k];
        from[k] = low < high ? low : begin_else;
        to[k] = low < high ? high : end_else;
    }
    for (std::size_t k = 0; k < block_queries; ++k) {
        const double low = from[k], high = to[k];
        const std::int32_t begin = static_cast<std::int32_t>(low), whole = static_cast<std::int32_t>(high);
        const double begin_place = begin, whole_place = whole;
        const std::int32_t end = whole + (whole_place < high ? 1 : 0);
        const double second = begin_place + 1.0, last = static_cast<double>(end) - 1.0;
        out.begin[k] = begin;
        out.end[k] = end;
        out.first[k] = std::min(second, high) - low;
        out.last[k] = high - std::max(low, last);
    }
    std::int32_t longest = 0;
    for (std::size_t k = 0; k < block_queries; ++k) longest = std::max(longest, out.end[k] - out.begin[k]);
    out.longest = longest;
}

SHADOWBENCH_SIMD_LOOP inline void nearest_of(const float* places, float per_pixel, BlockSide& out) {
    for (std::size_t k = 0; k < block_queries; ++k) {
        out.begin[k] = static_cast<std::int32_t>(places[k] * per_pixel);
        out.end[k] = out.begin[k] + 1;
    }
}

// Sets the places of the queries in the map, 0 for one outside, and what `out` holds besides the cells.
SHADOWBENCH_SIMD_LOOP inline void find_places(const CellGrid& grid, const Query* queries, Places& places, Cover& out) {
    bool* __restrict in_map = out.inside.data();
    const float width = static_cast<float>(grid.width), height = static_cast<float>(grid.height);
    for (std::size_t k = 0; k < block_queries; ++k) {
        const float x = queries[k].x * grid.per_pixel_x, y = queries[k].y * grid.per_pixel_y;
        const bool inside = (x >= 0.0f) & (y >= 0.0f) & (x < width) & (y < height);
        in_map[k] = inside;
        places.x[k] = inside ? queries[k].x : 0.0f;
        places.y[k] = inside ? queries[k].y : 0.0f;
        places.width[k] = width_of(queries[k]);
    }
    std::int32_t widest = 0;  // bits of floats, none of them negative, which have their order
    for (std::size_t k = 0; k < block_queries; ++k)
        widest = std::max(widest, std::bit_cast<std::int32_t>(places.width[k]));
    out.widest = std::bit_cast<float>(widest);
}

// A full block: the queries, then some outside the map.
class FullBlock {
public:
    explicit FullBlock(std::span<const Query> queries) : first_(queries.data()) {
        if (queries.size() == block_queries) return;
        padded_.fill({-1.0f, -1.0f, 0.0f, 0.0f});
        std::copy(queries.begin(), queries.end(), padded_.begin());
        first_ = padded_.data();
    }
    const Query* data() const { return first_; }

private:
    std::array<Query, block_queries> padded_;
    const Query* first_;
};

}  // namespace

void cover(const CellGrid& grid, std::span<const Query> queries, Cover& out) {
    const FullBlock block(queries);
    base::on_simd_path([&]() SHADOWBENCH_SIMD_LOOP {
        Places places;
        find_places(grid, block.data(), places, out);
        side_of(places.x.data(), places.width.data(), grid.per_pixel_x, grid.width, out.across);
        side_of(places.y.data(), places.width.data(), grid.per_pixel_y, grid.height, out.down);
    });
}

void cover_nearest(const CellGrid& grid, std::span<const Query> queries, Cover& out) {
    const FullBlock block(queries);
    for (BlockSide* side : {&out.across, &out.down}) {
        side->first.fill(1.0);
        side->last.fill(1.0);
        side->longest = 1;
    }
    base::on_simd_path([&]() SHADOWBENCH_SIMD_LOOP {
        Places places;
        find_places(grid, block.data(), places, out);
        nearest_of(places.x.data(), grid.per_pixel_x, out.across);
        nearest_of(places.y.data(), grid.per_pixel_y, out.down);
    });
}

void four_cells(const Cover& cover, int width, CellSlots& cells) {
    base::on_simd_path([&cover, row = static_cast<std::uint32_t>(width), to = cells.data()]() SHADOWBENCH_SIMD_LOOP {
        std::size_t* __restrict cell = to;
        for (std::size_t k = 0; k < block_queries; ++k) {
            // Widened products of what is not negative: an index may have more than 32 bits.
            const std::uint32_t left = static_cast<std::uint32_t>(cover.across.begin[k]);
            const std::uint32_t right = static_cast<std::uint32_t>(cover.across.end[k]) - 1;
            const std::uint32_t upper = static_cast<std::uint32_t>(cover.down.begin[k]);
            const std::uint32_t lower = static_cast<std::uint32_t>(cover.down.end[k]) - 1;
            const std::size_t first = std::size_t{upper} * row, second = std::size_t{lower} * row;
            cell[k] = first + left;
            cell[block_queries + k] = first + right;
            cell[2 * block_queries + k] = second + left;
            cell[3 * block_queries + k] = second + right;
        }
    });
}

}  // namespace shadowbench::techniques
