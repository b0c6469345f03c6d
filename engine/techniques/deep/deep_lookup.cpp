#include "techniques/deep/deep_lookup.h"

#include "techniques/deep/deep_file.h"
#include "techniques/deep/filtered_lookup.h"

namespace shadowbench::techniques {
namespace {

struct InMemory {
    std::span<const DeepLevel> all;

    int width() const { return all[0].width; }
    int height() const { return all[0].height; }
    std::size_t levels() const { return all.size(); }

    template <int channels, class SegmentSearch>
    [[gnu::always_inline]] std::array<float, channels> at(int number, int x, int y, float z,
                                                          SegmentSearch& search) const {
        const DeepLevel& level = all[static_cast<std::size_t>(number)];
        const std::size_t pixel = level.pixel(x, y);
        const std::uint32_t begin = level.offsets[pixel], size = level.offsets[pixel + 1] - begin;
        if (size == 0) return lit<channels>();
        const bool coloured = channels == 3 && level.has_colour(pixel);
        return evaluate<channels>(level.floats.data() + begin, size / (coloured ? 4 : 2), coloured, z, search);
    }

    void prefetch_offsets(int x, int y) const { __builtin_prefetch(&all[0].offsets[all[0].pixel(x, y)]); }
    void prefetch_nodes(int x, int y) const {
        const float* nodes = all[0].floats.data() + all[0].offsets[all[0].pixel(x, y)];
        __builtin_prefetch(nodes);
        __builtin_prefetch(nodes + 16);
    }
};

}  // namespace

void lookup(std::span<const DeepLevel> levels, const LookupRule& rule, std::span<const Query> queries,
            std::span<const Footprint> footprints, std::span<float> visibility) {
    if (levels[0].channels == 3)
        lookup_channels<3>(InMemory{levels}, rule, queries, footprints, visibility);
    else
        lookup_channels<1>(InMemory{levels}, rule, queries, footprints, visibility);
}

void touched(std::span<const DeepLevel> levels, const LookupRule& rule, const Query& q, const Footprint& footprint,
             std::vector<const void*>& lines) {
    const std::size_t before = lines.size();
    const auto touch = [&](const void* first, std::size_t bytes) { touch_lines(first, bytes, lines); };
    for_each_read(levels[0].width, levels[0].height, levels.size(), rule, q, footprint, [&](int l, int x, int y) {
        const DeepLevel& level = levels[static_cast<std::size_t>(l)];
        const std::size_t p = level.pixel(x, y);
        touch(&level.offsets[p], 2 * sizeof(std::uint32_t));
        if (!level.coloured.empty()) touch(&level.coloured[p / 64], sizeof(std::uint64_t));
        const float* depths = level.floats.data() + level.offsets[p];
        touch_function({depths, level.nodes(p), level.has_colour(p) ? 3 : 1}, q.z, rule.search, touch);
    });
    keep_unique(lines, before);
}

}  // namespace shadowbench::techniques
