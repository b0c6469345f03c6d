// Reads a deep shadow map file through a fixed number of tiles in memory (Lokovic and Veach 2000, section 5.4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "techniques/deep/deep_file.h"
#include "techniques/technique.h"

namespace shadowbench::techniques {

// Holds up to `slots` tiles of all levels together; a new tile replaces the one used longest ago. A slot's memory grows
// to the largest tile that it has held and never shrinks.
//
// Deliberately not thread-safe: a function is valid only while its tile is held, which another thread could end. Each
// thread has a cache of its own; they share the DeepFile, which must outlive them.
class TileCache {
public:
    // Makes at least one slot, and none beyond the number of the file's tiles. Opens and reads nothing yet.
    TileCache(const DeepFile& file, std::size_t slots);

    const DeepFile& file() const { return *file_; }

    // The function of pixel (x, y) of a level, which must exist. Valid until the next call that misses. Throws what
    // DeepFile::read_tile throws; the cache stays usable then.
    DeepFunction function(int x, int y, int level) {
        const std::size_t tile = file_->tile_of(x, y, level);
        const Slot& slot = slots_[newest_ != none && slots_[newest_].tile == tile ? hit() : find(tile)];
        const int size = file_->tile_size();
        const std::size_t pixel =
            static_cast<std::size_t>(y % size) * file_->tile_width(x, level) + static_cast<std::size_t>(x % size);
        return function_of(slot.memory.get(), slot.pixels, file_->channels(), pixel);
    }

    std::uint64_t hits() const { return hits_; }
    std::uint64_t misses() const { return misses_; }
    std::size_t tile_bytes() const { return tile_bytes_; }  // memory of the slots
    std::size_t bytes() const;                              // everything that the cache holds

private:
    static constexpr std::uint32_t none = 0xffffffff;
    struct Slot {
        std::size_t tile = 0, pixels = 0, capacity = 0;
        std::unique_ptr<std::byte[]> memory;
        std::uint32_t newer = none, older = none;
    };
    std::uint32_t hit() {
        ++hits_;
        return newest_;
    }
    std::uint32_t find(std::size_t tile);
    std::uint32_t load(std::size_t tile);
    void unlink(std::uint32_t slot);
    void make_newest(std::uint32_t slot);

    const DeepFile* file_;
    std::vector<Slot> slots_;
    std::vector<std::uint32_t> free_;     // slots without a tile
    std::vector<std::uint32_t> slot_of_;  // for every tile of the file
    std::uint32_t newest_ = none, oldest_ = none;
    std::uint64_t hits_ = 0, misses_ = 0;
    std::size_t tile_bytes_ = 0;
};

// Answers queries, which are in pixels of level 0, from one level: the mean over the level's pixels that the footprint
// covers, each weighted by the part that is covered (Kernel::box in deep_lookup.h). Channel after channel:
// visibility[c * queries.size() + i] is the answer to queries[i]. Outside the map: lit. Throws what TileCache::function
// throws.
void lookup(TileCache& cache, int level, std::span<const Query> queries, std::span<float> visibility);

}  // namespace shadowbench::techniques
