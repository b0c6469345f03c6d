#include "techniques/deep/deep_lookup.h"

#include <array>

#include "techniques/deep/deep_file.h"
#include "techniques/deep/filtered_lookup.h"
#include "techniques/deep/segments.h"
#include "techniques/store/reads.h"

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

// Blocks of lookups that each read at most 2 x 2 pixels of the map, of one channel: all are searched, joined and
// averaged side by side, with the bits of Lookup.
class BlockLookup {
public:
    BlockLookup(const DeepLevel& map, const LookupRule& rule)
        : map_(map), rule_(rule), grid_{map.width, map.height, 1.0f, 1.0f} {}

    // Returns false, and does nothing, for a block that it cannot take.
    bool run(std::span<const Query> block, std::span<float> answers) {
        if (block.size() < Reads::fewest_in_slots || !arrange(block)) return false;
        for (std::size_t k = 0; k < block.size(); ++k) segments_.z[k] = block[k].z;
        std::fill(segments_.z.begin() + block.size(), segments_.z.end(), 0.0f);
        std::array<float, block_queries> means;
        find_segments(map_, segments_);
        mean_of(segments_, weights_.data(), means.data());
        for (std::size_t k = 0; k < block.size(); ++k) answers[k] = covered_.inside[k] ? means[k] : 1.0f;
        return true;
    }

private:
    bool arrange(std::span<const Query> block) {
        if (rule_.kernel == Kernel::box) {
            cover(grid_, block, covered_);
            if (covered_.widest > widest_few(rule_) || covered_.across.longest > 2 || covered_.down.longest > 2)
                return false;
            set_weights(covered_, weights_.data());
        } else {
            cover_nearest(grid_, block, covered_);
            if (covered_.widest > widest_few(rule_)) return false;
        }
        if (rule_.kernel == Kernel::tent)
            for (std::size_t k = 0; k < block_queries; ++k)
                if (!arrange_tent(k, k < block.size() && covered_.inside[k] ? block[k] : Query{0.5f, 0.5f, 0.0f, 0.0f}))
                    return false;
        four_cells(covered_, map_.width, segments_.pixel);
        segments_.slots = covered_.down.longest > 1 ? 4 : static_cast<std::size_t>(covered_.across.longest);
        return true;
    }
    bool arrange_tent(std::size_t k, const Query& q) {
        const Side across(Kernel::tent, q.x, 1.0f, static_cast<float>(map_.width));
        const Side down(Kernel::tent, q.y, 1.0f, static_cast<float>(map_.height));
        if (across.end - across.begin > 2 || down.end - down.begin > 2) return false;
        covered_.across.longest = covered_.down.longest = 2;
        covered_.across.begin[k] = across.begin;
        covered_.across.end[k] = across.end;
        covered_.down.begin[k] = down.begin;
        covered_.down.end[k] = down.end;
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const bool read = across.begin + i < across.end && down.begin + j < down.end;
                weights_[static_cast<std::size_t>(2 * j + i) * block_queries + k] =
                    read ? down.weight(down.begin + j) * across.weight(across.begin + i) : 0.0;
            }
        return true;
    }

    const DeepLevel& map_;
    const LookupRule& rule_;
    CellGrid grid_;
    Cover covered_;
    Segments segments_;
    alignas(64) std::array<double, Segments::most> weights_;
};

void lookup_blocks(std::span<const DeepLevel> levels, const LookupRule& rule, std::span<const Query> queries,
                   std::span<float> visibility) {
    Lookup<1, BinarySearch, InMemory> others(InMemory{levels}, rule);
    if (queries.size() < Reads::fewest_in_slots) return others.run(queries, visibility);
    BlockLookup blocks(levels[0], rule);
    for (std::size_t start = 0; start < queries.size(); start += block_queries) {
        const std::span<const Query> block = queries.subspan(start, std::min(block_queries, queries.size() - start));
        const std::span<float> answers = visibility.subspan(start, block.size());
        if (!blocks.run(block, answers)) others.run(block, answers);
    }
}

}  // namespace

void lookup(std::span<const DeepLevel> levels, const LookupRule& rule, std::span<const Query> queries,
            std::span<const Footprint> footprints, std::span<float> visibility) {
    if (levels[0].channels == 3) return lookup_channels<3>(InMemory{levels}, rule, queries, footprints, visibility);
    if (rule.search == Search::binary && (rule.probes == 0 || footprints.empty()))
        return lookup_blocks(levels, rule, queries, visibility);
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
