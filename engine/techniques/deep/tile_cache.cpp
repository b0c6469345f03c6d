#include "techniques/deep/tile_cache.h"

#include <algorithm>
#include <cmath>

#include "techniques/cells.h"

namespace shadowbench::techniques {

TileCache::TileCache(const DeepFile& file, std::size_t slots)
    : file_(&file), slots_(std::clamp<std::size_t>(slots, 1, file.tiles())), slot_of_(file.tiles(), none) {
    for (std::size_t i = slots_.size(); i > 0; --i) free_.push_back(static_cast<std::uint32_t>(i - 1));
}

std::size_t TileCache::bytes() const {
    return tile_bytes_ + slots_.capacity() * sizeof(Slot) +
           (free_.capacity() + slot_of_.capacity()) * sizeof(std::uint32_t);
}

void TileCache::unlink(std::uint32_t slot) {
    Slot& s = slots_[slot];
    (s.newer == none ? newest_ : slots_[s.newer].older) = s.older;
    (s.older == none ? oldest_ : slots_[s.older].newer) = s.newer;
    s.newer = s.older = none;
}

void TileCache::make_newest(std::uint32_t slot) {
    slots_[slot].older = newest_;
    (newest_ == none ? oldest_ : slots_[newest_].newer) = slot;
    newest_ = slot;
}

std::uint32_t TileCache::find(std::size_t tile) {
    const std::uint32_t slot = slot_of_[tile];
    if (slot == none) return load(tile);
    ++hits_;
    unlink(slot);
    make_newest(slot);
    return slot;
}

std::uint32_t TileCache::load(std::size_t tile) {
    ++misses_;
    if (free_.empty()) {
        const std::uint32_t oldest = oldest_;
        unlink(oldest);
        slot_of_[slots_[oldest].tile] = none;
        free_.push_back(oldest);
    }
    const std::uint32_t slot = free_.back();
    Slot& s = slots_[slot];
    const std::size_t bytes = file_->tile_bytes(tile);
    if (s.capacity < bytes) {
        tile_bytes_ -= s.capacity;
        s.capacity = 0;
        s.memory.reset();  // before the larger one comes
        s.memory = std::make_unique_for_overwrite<std::byte[]>(bytes);
        s.capacity = bytes;
        tile_bytes_ += bytes;
    }
    file_->read_tile(tile, s.memory.get());
    free_.pop_back();
    s.tile = tile;
    s.pixels = file_->tile_pixels(tile);
    slot_of_[tile] = slot;
    make_newest(slot);
    return slot;
}

void lookup(TileCache& cache, int level, std::span<const Query> queries, std::span<float> visibility) {
    const DeepTiling& tiling = cache.file().levels()[static_cast<std::size_t>(level)];
    const CellGrid grid{tiling.width, tiling.height, 1.0f, 1.0f};
    const int channels = cache.file().channels();
    const float scale = std::ldexp(1.0f, -level);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const Query& q = queries[i];
        const CellRange r = footprint(grid, {q.x * scale, q.y * scale, q.z, q.width * scale});
        double sum[3] = {0.0, 0.0, 0.0};  // as the map in memory sums, to the bit
        for (int y = r.y0; y < r.y1; ++y)
            for (int x = r.x0; x < r.x1; ++x) {
                const DeepFunction function = cache.function(x, y, level);
                for (int c = 0; c < channels; ++c) sum[c] += evaluate(function, c, q.z);
            }
        const int pixels = (r.x1 - r.x0) * (r.y1 - r.y0);
        for (int c = 0; c < channels; ++c)
            visibility[static_cast<std::size_t>(c) * queries.size() + i] =
                pixels > 0 ? std::min(static_cast<float>(sum[c] / pixels), 1.0f) : 1.0f;
    }
}

}  // namespace shadowbench::techniques
