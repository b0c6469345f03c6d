// A finished deep shadow map that stays in a file and is looked up through a fixed number of tiles in memory (Lokovic
// and Veach 2000, section 5.4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "curves/curve.h"
#include "techniques/deep/deep_file.h"
#include "techniques/deep/tile_cache.h"

namespace shadowbench::techniques {

inline constexpr int tile_side = 16;  // pixels

// What lookups did to the tiles so far, and the bytes that are held now.
struct TileCounts {
    std::size_t tiles = 0;  // of the file, of all levels
    std::size_t slots = 0;
    std::uint64_t hits = 0;      // functions whose tile was in a slot
    std::uint64_t misses = 0;    // the others: each loads a tile
    std::size_t slot_bytes = 0;  // memory of the slots
    std::size_t held_bytes = 0;  // that, the directory of the file, and the tables of the cache
    std::uint64_t file_bytes = 0;
};

class TiledMap {
public:
    // Writes the levels to a temporary file without a name, which goes with this map. Throws what write_deep_file
    // throws; Error{io} says what to do.
    TiledMap(std::span<const DeepLevel> levels, std::size_t slots, const DeepFileNotes& notes);

    // As of the levels in memory, bit for bit. Thread-safe: there is one set of slots, so threads take turns.
    void lookup(const LookupRule& rule, std::span<const Query> queries, std::span<const Footprint> footprints,
                std::span<float> visibility) const;
    void touched(const LookupRule& rule, const Query& query, const Footprint& footprint,
                 std::vector<const void*>& lines) const;
    // The function of a pixel of level 0; `out` is replaced.
    void stored(int x, int y, int channel, curves::Curve& out) const;

    TileCounts counts() const;
    // Held when all slots have grown to the largest tile. It does not depend on what was looked up.
    std::size_t bytes() const;

private:
    std::unique_ptr<const DeepFile> file_;
    mutable std::mutex mutex_;
    mutable TileCache cache_;
};

}  // namespace shadowbench::techniques
