// Reads a deep shadow map file through a fixed number of tiles in memory (Lokovic and Veach 2000, section 5.4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "techniques/deep/deep_file.h"
#include "techniques/deep/deep_lookup.h"
#include "techniques/technique.h"

namespace shadowbench::techniques {

// Holds up to `slots` tiles of all levels together; a new tile replaces the one used longest ago. A slot's memory grows
// to the largest tile that it has held and never shrinks.
//
// Deliberately not thread-safe: a function is valid only while its tile is held, which another thread could end. A
// cache serves one thread at a time; several caches may share the DeepFile, which must outlive them.
class TileCache {
public:
    // Makes at least one slot, and none beyond the number of the file's tiles. Opens and reads nothing yet.
    TileCache(const DeepFile& file, std::size_t slots);

    const DeepFile& file() const { return *file_; }

    // The function of pixel (x, y) of a level, which must exist. Valid until the next call that misses; the
    // DeepLevel::padding floats behind its tile may be read. Throws what DeepFile::read_tile throws; the cache stays
    // usable then.
    DeepFunction function(int x, int y, int level) {
        const std::size_t tile = file_->tile_of(x, y, level);
        const Slot& slot = slots_[newest_ != none && slots_[newest_].tile == tile ? hit() : find(tile)];
        return function_of(slot.memory.get(), slot.pixels, file_->channels(), pixel_in_tile(x, y, level));
    }
    // The number of pixel (x, y) of a level among those of its tile.
    std::size_t pixel_in_tile(int x, int y, int level) const {
        const int size = file_->tile_size();
        return static_cast<std::size_t>(y % size) * file_->tile_width(x, level) + static_cast<std::size_t>(x % size);
    }

    // The tile of the last call of function(): its number, and the address in the mapped file of what lies at `place`
    // in the cache's memory of it.
    std::size_t last_tile() const { return slots_[newest_].tile; }
    const std::byte* in_file(const void* place) const {
        const Slot& slot = slots_[newest_];
        return file_->mapped_tile(slot.tile) + (static_cast<const std::byte*>(place) - slot.memory.get());
    }

    std::size_t slots() const { return slots_.size(); }
    std::uint64_t hits() const { return hits_; }                       // functions whose tile was held
    std::uint64_t misses() const { return misses_; }                   // the others: each loads a tile
    std::size_t tile_bytes() const { return tile_bytes_; }             // memory of the slots
    std::size_t bytes() const { return tile_bytes_ + table_bytes(); }  // everything that the cache holds
    std::size_t most_bytes() const;                                    // the same when all slots have grown

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
    std::size_t table_bytes() const;

    const DeepFile* file_;
    std::vector<Slot> slots_;
    std::vector<std::uint32_t> free_;     // slots without a tile
    std::vector<std::uint32_t> slot_of_;  // for every tile of the file
    std::uint32_t newest_ = none, oldest_ = none;
    std::uint64_t hits_ = 0, misses_ = 0;
    std::size_t tile_bytes_ = 0;
};

// Answer queries, which are in pixels of level 0, with the same bits as the map in memory from which the file was
// written: see deep_lookup.h. The file must have the levels that the rule asks for. Throw what TileCache::function
// throws.
void lookup(TileCache& cache, const LookupRule& rule, std::span<const Query> queries,
            std::span<const Footprint> footprints, std::span<float> visibility);
// Addresses in the mapped file: what a lookup reads there if it reads nothing else.
void touched(TileCache& cache, const LookupRule& rule, const Query& query, const Footprint& footprint,
             std::vector<const void*>& lines);

}  // namespace shadowbench::techniques
