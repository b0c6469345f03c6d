#include "techniques/deep/deep_file_format.h"
#include "techniques/deep/filtered_lookup.h"
#include "techniques/deep/tile_cache.h"

namespace shadowbench::techniques {
namespace {

struct InTiles {
    TileCache* cache;

    int width() const { return cache->file().levels()[0].width; }
    int height() const { return cache->file().levels()[0].height; }
    std::size_t levels() const { return cache->file().levels().size(); }

    template <int channels, class SegmentSearch>
    std::array<float, channels> at(int level, int x, int y, float z, SegmentSearch& search) const {
        const DeepFunction f = cache->function(x, y, level);
        if (f.nodes == 0) return lit<channels>();
        return evaluate<channels>(f.depths, f.nodes, f.channels == 3, z, search);
    }

    // A tile may have to be loaded first: nothing is known of its addresses before.
    void prefetch_offsets(int, int) const {}
    void prefetch_nodes(int, int) const {}
};

}  // namespace

void lookup(TileCache& cache, const LookupRule& rule, std::span<const Query> queries,
            std::span<const Footprint> footprints, std::span<float> visibility) {
    if (cache.file().channels() == 3)
        lookup_channels<3>(InTiles{&cache}, rule, queries, footprints, visibility);
    else
        lookup_channels<1>(InTiles{&cache}, rule, queries, footprints, visibility);
}

void touched(TileCache& cache, const LookupRule& rule, const Query& q, const Footprint& footprint,
             std::vector<const void*>& lines) {
    const DeepFile& file = cache.file();
    const DeepTiling& map = file.levels()[0];
    const std::size_t before = lines.size();
    for_each_read(map.width, map.height, file.levels().size(), rule, q, footprint, [&](int level, int x, int y) {
        const DeepFunction f = cache.function(x, y, level);
        const std::byte* const tile = file.mapped_tile(cache.last_tile());
        const std::size_t pixel = cache.pixel_in_tile(x, y, level);
        const std::size_t pixels = file.tile_pixels(cache.last_tile());
        touch_lines(tile + pixel * sizeof(std::uint32_t), 2 * sizeof(std::uint32_t), lines);
        if (file.channels() == 3)
            touch_lines(tile + (pixels + 1 + pixel / 32) * sizeof(std::uint32_t), sizeof(std::uint32_t), lines);
        touch_function(f, q.z, rule.search,
                       [&](const void* first, std::size_t bytes) { touch_lines(cache.in_file(first), bytes, lines); });
    });
    keep_unique(lines, before);
}

}  // namespace shadowbench::techniques
