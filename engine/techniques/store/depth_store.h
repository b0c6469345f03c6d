// Depths of a grid of cells, n floats each, kept in one of the three ways of Reeves, Salesin, Cook 1987, section 3.3:
// raw; inside the bounding box of the finite depths; in tiles. Empty tiles are not kept, and each tile knows its least
// and greatest depth, so that a lookup wholly before or behind a tile need not read its cells. Lookups give the same
// bits in all three.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "techniques/store/cells.h"

namespace shadowbench::techniques {

constexpr float no_depth = std::numeric_limits<float>::infinity();  // where a ray crosses nothing: nothing is behind it
constexpr int most_depths = 8;                                      // of a cell

enum class Storage { raw, bounding_box, tiles };

inline const Parameter storage_parameter{
    "storage",
    ParameterKind::choice,
    "all cells; those in the bounding box of finite depths; tiles of 32 x 32 cells with their least and greatest depth",
    0,
    0,
    0,
    "raw",
    {"raw", "bounding_box", "tiles"}};
// Its trade of bytes against the time of a lookup; the answers are equal.
inline const Trade storage_trade{.parameter = "storage", .choices = {"raw", "bounding_box", "tiles"}, .only_layout = true};
inline Storage read_storage(const ParameterValues& values) {
    const std::string& word = values.word("storage");
    return word == "raw" ? Storage::raw : word == "tiles" ? Storage::tiles : Storage::bounding_box;
}

// Every depth of some cells is in [least, greatest].
struct DepthBounds {
    float least = -no_depth, greatest = no_depth;
};

// The three readers. All have:
//   at(x, y)       the depths of a cell inside the grid
//   window(range)  the memory that holds all cells of a range, if there is one: reads from it are faster
//   bounds(range)  the bounds of the cells of a range inside the grid, found without reading cells; only if `bounded`
//   touch...       the lines that the two read
inline constexpr float empty_cell[most_depths] = {no_depth, no_depth, no_depth, no_depth,
                                                  no_depth, no_depth, no_depth, no_depth};

// Depths of cells whose rows are `stride` cells apart, from cell (x0, y0) on.
struct DepthWindow {
    const float* depths = nullptr;
    int stride = 0, x0 = 0, y0 = 0, per_cell = 1;

    const float* at(int x, int y) const {
        return depths + (static_cast<std::ptrdiff_t>(y - y0) * stride + (x - x0)) * per_cell;
    }
};

struct RawDepths {
    static constexpr bool bounded = false;
    const float* depths;
    int width, per_cell;

    const float* at(int x, int y) const { return depths + (static_cast<std::size_t>(y) * width + x) * per_cell; }
    bool window(const CellRange&, DepthWindow& out) const {
        out = {depths, width, 0, 0, per_cell};
        return true;
    }
    void touch(int x, int y, std::vector<const void*>& lines) const {
        touch_lines(at(x, y), per_cell * sizeof(float), lines);
    }
};

struct BoxedDepths {
    static constexpr bool bounded = true;
    const float* depths;
    CellRange box;
    int per_cell;

    // Without branches, which queries in random order would mispredict.
    bool holds(int x, int y) const {
        return (static_cast<unsigned>(x - box.x0) < static_cast<unsigned>(box.x1 - box.x0)) &
               (static_cast<unsigned>(y - box.y0) < static_cast<unsigned>(box.y1 - box.y0));
    }
    const float* at(int x, int y) const {
        const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(y - box.y0) * (box.x1 - box.x0);
        const std::ptrdiff_t offset = (row + (x - box.x0)) * per_cell;
        return (holds(x, y) ? depths : empty_cell) + (holds(x, y) ? offset : 0);
    }
    bool window(const CellRange& r, DepthWindow& out) const {
        out = {depths, box.x1 - box.x0, box.x0, box.y0, per_cell};
        return r.x0 >= box.x0 && r.x1 <= box.x1 && r.y0 >= box.y0 && r.y1 <= box.y1;
    }
    DepthBounds bounds(const CellRange& r) const {
        const bool apart = r.x1 <= box.x0 || r.x0 >= box.x1 || r.y1 <= box.y0 || r.y0 >= box.y1;
        return {apart ? no_depth : -no_depth, no_depth};
    }
    void touch(int x, int y, std::vector<const void*>& lines) const {
        if (holds(x, y)) touch_lines(at(x, y), per_cell * sizeof(float), lines);
    }
    void touch_bounds(const CellRange&, std::vector<const void*>&) const {}
};

constexpr int tile_side = 32;  // cells, as in the paper's table 2

struct DepthTile {
    static constexpr std::uint32_t nowhere = 0xffffffffu;
    DepthBounds bounds{no_depth, no_depth};
    std::uint32_t number = nowhere;  // among the tiles that are kept
};

struct TiledDepths {
    static constexpr bool bounded = true;
    const float* depths;
    const DepthTile* tiles;
    int tiles_x, per_cell;

    // Unsigned, so that divisions by a power of two become shifts.
    static unsigned tile_of(int cell) { return static_cast<unsigned>(cell) / tile_side; }
    static unsigned inside_tile(int cell) { return static_cast<unsigned>(cell) % tile_side; }
    const DepthTile& tile(int x, int y) const {
        return tiles[static_cast<std::size_t>(tile_of(y)) * tiles_x + tile_of(x)];
    }
    const float* at(int x, int y) const {
        const DepthTile& t = tile(x, y);
        if (t.number == DepthTile::nowhere) return empty_cell;
        const std::size_t row = static_cast<std::size_t>(t.number) * tile_side + inside_tile(y);
        return depths + (row * tile_side + inside_tile(x)) * per_cell;
    }
    bool window(const CellRange& r, DepthWindow& out) const {
        const DepthTile& t = tile(r.x0, r.y0);
        if (!one_tile(r) || t.number == DepthTile::nowhere) return false;
        const std::size_t first = static_cast<std::size_t>(t.number) * tile_side * tile_side * per_cell;
        out = {depths + first, tile_side, r.x0 - static_cast<int>(inside_tile(r.x0)),
               r.y0 - static_cast<int>(inside_tile(r.y0)), per_cell};
        return true;
    }
    DepthBounds bounds(const CellRange& r) const {
        if (one_tile(r)) return tile(r.x0, r.y0).bounds;
        DepthBounds found{no_depth, -no_depth};
        for_each_tile(r, [&](const DepthTile& t) {
            found.least = std::min(found.least, t.bounds.least);
            found.greatest = std::max(found.greatest, t.bounds.greatest);
        });
        return found;
    }
    void touch(int x, int y, std::vector<const void*>& lines) const {
        touch_lines(&tile(x, y), sizeof(DepthTile), lines);
        if (tile(x, y).number != DepthTile::nowhere) touch_lines(at(x, y), per_cell * sizeof(float), lines);
    }
    void touch_bounds(const CellRange& r, std::vector<const void*>& lines) const {
        for_each_tile(r, [&](const DepthTile& t) { touch_lines(&t, sizeof t, lines); });
    }

private:
    static bool one_tile(const CellRange& r) {
        return tile_of(r.x0) == tile_of(r.x1 - 1) && tile_of(r.y0) == tile_of(r.y1 - 1);
    }
    template <class Visit>
    void for_each_tile(const CellRange& r, const Visit& visit) const {
        for (unsigned y = tile_of(r.y0); y <= tile_of(r.y1 - 1); ++y)
            for (unsigned x = tile_of(r.x0); x <= tile_of(r.x1 - 1); ++x)
                visit(tiles[static_cast<std::size_t>(y) * tiles_x + x]);
    }
};

class DepthStore {
public:
    // Takes `per_cell` (1 to most_depths) depths for each cell of the grid, row after row; a cell without depths has
    // no_depth.
    void keep(Storage way, const CellGrid& grid, int per_cell, std::vector<float>&& depths);

    // visit(one of the three readers)
    template <class Visit>
    void read(const Visit& visit) const {
        switch (way_) {
            case Storage::raw:
                return visit(RawDepths{depths_.data(), grid_.width, per_cell_});
            case Storage::bounding_box:
                return visit(BoxedDepths{depths_.data(), box_, per_cell_});
            case Storage::tiles:
                return visit(TiledDepths{depths_.data(), tiles_.data(), tiles_x(), per_cell_});
        }
    }
    // The depths of one cell: a pointer to per_cell() of them.
    const float* at(int x, int y) const;

    int per_cell() const { return per_cell_; }
    const CellGrid& grid() const { return grid_; }
    std::size_t bytes() const { return depths_.capacity() * sizeof(float) + tiles_.capacity() * sizeof(DepthTile); }
    NodeStats nodes() const;  // finite depths per cell

private:
    int tiles_x() const { return (grid_.width + tile_side - 1) / tile_side; }
    void keep_box(const std::vector<float>& depths);
    void keep_tiles(const std::vector<float>& depths);

    Storage way_ = Storage::raw;
    CellGrid grid_;
    int per_cell_ = 1;
    CellRange box_;  // of cells with a finite depth
    std::vector<DepthTile> tiles_;
    std::vector<float> depths_;
};

// The least number of bytes that a store of this grid holds, whatever the depths are.
std::size_t least_store_bytes(Storage way, const CellGrid& grid, int per_cell);

}  // namespace shadowbench::techniques
