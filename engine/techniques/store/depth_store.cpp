#include "techniques/store/depth_store.h"

#include <algorithm>
#include <utility>

namespace shadowbench::techniques {
namespace {

// Calls visit(pointer to the depths) for the rows of a range: row after row, each contiguous.
template <class Visit>
void for_each_row(const CellGrid& grid, int per_cell, const CellRange& r, const std::vector<float>& depths,
                  const Visit& visit) {
    const std::size_t count = static_cast<std::size_t>(r.x1 - r.x0) * per_cell;
    for (int y = r.y0; y < r.y1; ++y) visit(y, depths.data() + grid.index(r.x0, y) * per_cell, count);
}

}  // namespace

void DepthStore::keep(Storage way, const CellGrid& grid, int per_cell, std::vector<float>&& depths) {
    way_ = way;
    grid_ = grid;
    per_cell_ = per_cell;
    std::vector<float> taken = std::move(depths);
    switch (way) {
        case Storage::raw:
            depths_ = std::move(taken);
            break;
        case Storage::bounding_box:
            keep_box(taken);
            break;
        case Storage::tiles:
            keep_tiles(taken);
            break;
    }
}

void DepthStore::keep_box(const std::vector<float>& depths) {
    box_ = {grid_.width, 0, grid_.height, 0};
    for_each_row(grid_, per_cell_, {0, grid_.width, 0, grid_.height}, depths,
                 [&](int y, const float* row, std::size_t count) {
                     for (std::size_t i = 0; i < count; ++i) {
                         if (row[i] == no_depth) continue;
                         const int x = static_cast<int>(i / per_cell_);
                         box_ = {std::min(box_.x0, x), std::max(box_.x1, x + 1), std::min(box_.y0, y), y + 1};
                     }
                 });
    if (box_.x0 >= box_.x1) box_ = {};
    depths_.reserve(static_cast<std::size_t>(box_.x1 - box_.x0) * (box_.y1 - box_.y0) * per_cell_);
    for_each_row(grid_, per_cell_, box_, depths,
                 [&](int, const float* row, std::size_t count) { depths_.insert(depths_.end(), row, row + count); });
}

void DepthStore::keep_tiles(const std::vector<float>& depths) {
    const int tiles_y = (grid_.height + tile_side - 1) / tile_side;
    tiles_.assign(static_cast<std::size_t>(tiles_x()) * tiles_y, {});
    const auto range_of = [&](std::size_t t) {
        const int x = static_cast<int>(t) % tiles_x() * tile_side, y = static_cast<int>(t) / tiles_x() * tile_side;
        return CellRange{x, std::min(x + tile_side, grid_.width), y, std::min(y + tile_side, grid_.height)};
    };
    std::uint32_t kept = 0;
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
        DepthBounds bounds{no_depth, -no_depth};
        for_each_row(grid_, per_cell_, range_of(t), depths, [&](int, const float* row, std::size_t count) {
            const auto [least, greatest] = std::minmax_element(row, row + count);
            bounds = {std::min(bounds.least, *least), std::max(bounds.greatest, *greatest)};
        });
        tiles_[t].bounds = bounds;
        if (bounds.least != no_depth) tiles_[t].number = kept++;
    }
    // Tiles at the right and the top edge are kept whole, so that all have one stride.
    const std::size_t row_size = static_cast<std::size_t>(tile_side) * per_cell_;
    depths_.assign(kept * tile_side * row_size, no_depth);
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
        if (tiles_[t].number == DepthTile::nowhere) continue;
        float* to = depths_.data() + tiles_[t].number * tile_side * row_size;
        for_each_row(grid_, per_cell_, range_of(t), depths, [&](int, const float* row, std::size_t count) {
            std::copy(row, row + count, to);
            to += row_size;
        });
    }
}

const float* DepthStore::at(int x, int y) const {
    const float* found = nullptr;
    read([&](const auto& depths) { found = depths.at(x, y); });
    return found;
}

NodeStats DepthStore::nodes() const {
    NodeStats stats;
    read([&](const auto& depths) {
        for (int y = 0; y < grid_.height; ++y)
            for (int x = 0; x < grid_.width; ++x) {
                const float* z = depths.at(x, y);
                stats.add(static_cast<std::uint32_t>(per_cell_ - std::count(z, z + per_cell_, no_depth)));
            }
    });
    return stats;
}

std::size_t least_store_bytes(Storage way, const CellGrid& grid, int per_cell) {
    const auto tiles = [](int cells) { return static_cast<std::size_t>((cells + tile_side - 1) / tile_side); };
    switch (way) {
        case Storage::raw:
            return grid.count() * per_cell * sizeof(float);
        case Storage::bounding_box:
            return 0;
        case Storage::tiles:
            return tiles(grid.width) * tiles(grid.height) * sizeof(DepthTile);
    }
    return 0;
}

}  // namespace shadowbench::techniques
