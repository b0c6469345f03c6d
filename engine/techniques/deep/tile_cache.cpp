#include "techniques/deep/tile_cache.h"

#include <algorithm>
#include <array>

#include "techniques/deep/footprint.h"

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
        s.memory.reset();  // before the larger one is allocated
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

namespace {

template <int channels>
void lookup_channels(TileCache& cache, int level, std::span<const Query> queries, std::span<float> visibility) {
    const DeepTiling& map = cache.file().levels()[0];
    const CellGrid grid{map.width, map.height, 1.0f, 1.0f};
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const Query& q = queries[i];
        std::array<float, channels> values;
        values.fill(1.0f);
        int cx, cy;
        if (grid.find(q.x, q.y, cx, cy)) {
            WeightedMean<channels> mean;  // the same bits as the map in memory
            for_each_pixel(map.width, map.height, level, Kernel::box, q, [&](int x, int y, double weight) {
                const DeepFunction function = cache.function(x, y, level);
                for (int c = 0; c < channels; ++c) values[c] = evaluate(function, c, q.z);
                mean.add(values, weight);
            });
            values = mean.value();
        }
        for (int c = 0; c < channels; ++c) visibility[static_cast<std::size_t>(c) * queries.size() + i] = values[c];
    }
}

}  // namespace

void lookup(TileCache& cache, int level, std::span<const Query> queries, std::span<float> visibility) {
    if (cache.file().channels() == 3)
        lookup_channels<3>(cache, level, queries, visibility);
    else
        lookup_channels<1>(cache, level, queries, visibility);
}

}  // namespace shadowbench::techniques
