#include "techniques/deep/tile_cache.h"

#include <algorithm>
#include <cstring>

namespace shadowbench::techniques {
namespace {

constexpr std::size_t padding_bytes = DeepLevel::padding * sizeof(float);

}  // namespace

TileCache::TileCache(const DeepFile& file, std::size_t slots)
    : file_(&file), slots_(std::clamp<std::size_t>(slots, 1, file.tiles())), slot_of_(file.tiles(), none) {
    for (std::size_t i = slots_.size(); i > 0; --i) free_.push_back(static_cast<std::uint32_t>(i - 1));
}

std::size_t TileCache::table_bytes() const {
    return slots_.capacity() * sizeof(Slot) + (free_.capacity() + slot_of_.capacity()) * sizeof(std::uint32_t);
}

std::size_t TileCache::most_bytes() const {
    std::size_t largest = 0, all = 0;
    for (std::size_t tile = 0; tile < file_->tiles(); ++tile) {
        const std::size_t bytes = file_->tile_bytes(tile) + padding_bytes;
        largest = std::max(largest, bytes);
        all += bytes;
    }
    // With a slot for every tile none is replaced.
    return table_bytes() + (slots_.size() == file_->tiles() ? all : slots_.size() * largest);
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
    const std::size_t bytes = file_->tile_bytes(tile), needed = bytes + padding_bytes;
    if (s.capacity < needed) {
        tile_bytes_ -= s.capacity;
        s.capacity = 0;
        s.memory.reset();  // before the larger one is allocated
        s.memory = std::make_unique_for_overwrite<std::byte[]>(needed);
        s.capacity = needed;
        tile_bytes_ += needed;
    }
    file_->read_tile(tile, s.memory.get());
    std::memset(s.memory.get() + bytes, 0, padding_bytes);
    free_.pop_back();
    s.tile = tile;
    s.pixels = file_->tile_pixels(tile);
    slot_of_[tile] = slot;
    make_newest(slot);
    return slot;
}

}  // namespace shadowbench::techniques
