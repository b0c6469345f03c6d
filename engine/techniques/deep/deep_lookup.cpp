#include "techniques/deep/deep_lookup.h"

#include <array>
#include <bit>

#include "techniques/deep/deep_file.h"
#include "techniques/deep/filtered_lookup.h"
#include "techniques/store/before.h"
#include "techniques/store/joins.h"
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

// Blocks of lookups that each read at most 2 x 2 pixels of the map, of one channel. Their cache lines are prefetched
// before the first is used, so that their misses overlap: first the offsets, then the nodes that they point to. Then all
// are searched, joined and averaged side by side, with the bits of Lookup.
class BlockLookup {
public:
    BlockLookup(const DeepLevel& map, const LookupRule& rule)
        : map_(map), rule_(rule), grid_{map.width, map.height, 1.0f, 1.0f} {}

    // Returns false, and does nothing, for a block that it cannot take.
    bool run(std::span<const Query> block, std::span<float> answers) {
        if (block.size() < Reads::fewest_in_slots || !arrange(block)) return false;
        for (std::size_t r = 0; r < reads_.count; ++r) __builtin_prefetch(&map_.offsets[pixel_[r]]);
        for (std::size_t r = 0; r < reads_.count; ++r) {
            const float* depths = map_.floats.data() + map_.offsets[pixel_[r]];
            __builtin_prefetch(depths);
            __builtin_prefetch(depths + floats_a_line);
        }
        std::array<float, block_queries> depths{};
        for (std::size_t k = 0; k < block.size(); ++k) depths[k] = block[k].z;
        for (std::size_t r = 0; r < reads_.count; ++r) search(r, depths[reads_.query[r]]);
        join(joins_, reads_.count, reads_.value.data());
        average(reads_, covered_.inside, 1.0f, answers);
        return true;
    }

private:
    static constexpr std::size_t floats_a_line = 16;

    bool arrange(std::span<const Query> block) {
        const float widest = rule_.kernel == Kernel::pixels || rule_.kernel == Kernel::tent ? 1.0f
                             : rule_.mip == Mip::none                                       ? 2.0f
                                                                                            : narrowest_mip(rule_);
        for (const Query& q : block)
            if (!(width_of(q) <= widest)) return false;
        if (rule_.kernel == Kernel::box) {
            cover(grid_, block, covered_);
            if (covered_.across.longest > 2 || covered_.down.longest > 2) return false;
            reads_.begin(4);
            set_weights(covered_, reads_);
            for (std::size_t k = 0; k < block_queries; ++k)
                put_four(k, covered_.across.begin[k], covered_.across.end[k], covered_.down.begin[k],
                         covered_.down.end[k]);
            return true;
        }
        cover_nearest(grid_, block, covered_);
        if (rule_.kernel == Kernel::pixels) {  // a pixel's width includes the nearest pixel, and no other
            reads_.begin(1);
            for (std::size_t k = 0; k < block_queries; ++k)
                pixel_[k] = map_.pixel(covered_.across.begin[k], covered_.down.begin[k]);
            return true;
        }
        reads_.begin(4);
        for (std::size_t k = 0; k < block_queries; ++k)
            if (!arrange_tent(k, k < block.size() && covered_.inside[k] ? block[k] : Query{0.5f, 0.5f, 0.0f, 0.0f}))
                return false;
        return true;
    }
    bool arrange_tent(std::size_t k, const Query& q) {
        const Side across(Kernel::tent, q.x, 1.0f, static_cast<float>(map_.width));
        const Side down(Kernel::tent, q.y, 1.0f, static_cast<float>(map_.height));
        if (across.end - across.begin > 2 || down.end - down.begin > 2) return false;
        put_four(k, across.begin, across.end, down.begin, down.end);
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const bool read = across.begin + i < across.end && down.begin + j < down.end;
                reads_.weight[(2 * j + i) * block_queries + k] =
                    read ? down.weight(down.begin + j) * across.weight(across.begin + i) : 0.0;
            }
        return true;
    }
    void put_four(std::size_t k, int x0, int x_end, int y0, int y_end) {
        const std::size_t low = map_.pixel(x0, y0), high = map_.pixel(x0, y_end - 1);
        const auto right = static_cast<std::size_t>(x_end - 1 - x0);
        pixel_[k] = low;
        pixel_[block_queries + k] = low + right;
        pixel_[2 * block_queries + k] = high;
        pixel_[3 * block_queries + k] = high + right;
    }

    // Finds the nodes around the depth of read r. Almost without branches: those of a search are hard to predict.
    [[gnu::always_inline]] void search(std::size_t r, float z) {
        constexpr std::uint32_t lanes = 16;
        // In place of a function without nodes, which is 1.
        static constexpr std::array<float, lanes> lit{0.0f, 1.0f};
        const std::uint32_t begin = map_.offsets[pixel_[r]], size = map_.offsets[pixel_[r] + 1] - begin;
        const float* depths = size > 0 ? map_.floats.data() + begin : lit.data();
        const std::uint32_t nodes = size > 0 ? size / 2 : 1;
        const float* first = depths;
        std::uint32_t n = nodes;
        while (n > lanes) {  // most functions are shorter
            const std::uint32_t half = n / 2;
            first += half & -static_cast<std::uint32_t>(first[half - 1] < z);
            n -= half;
        }
        // The last functions of the map may be nearer to its end than a vector is long.
        const bool whole = begin + lanes <= map_.floats.size();
        const std::uint32_t before = (whole ? depths_before<lanes>(first, z) : few_before(first, n, z)) & ((1u << n) - 1);
        const auto next = static_cast<std::uint32_t>(first - depths) +
                          static_cast<std::uint32_t>(31 - std::countl_zero(before << 1 | 1u));
        // Before the first node and behind the last one both are the same.
        const std::uint32_t left = next - (next > 0), right = next - (next == nodes);
        joins_.z[r] = z;
        joins_.left_z[r] = depths[left];
        joins_.right_z[r] = depths[right];
        joins_.left_value[r] = depths[nodes + left];
        joins_.right_value[r] = depths[nodes + right];
    }
    static std::uint32_t few_before(const float* depths, std::uint32_t n, float z) {
        std::uint32_t before = 0;
        for (std::uint32_t i = 0; i < n; ++i) before |= static_cast<std::uint32_t>(depths[i] < z) << i;
        return before;
    }

    const DeepLevel& map_;
    const LookupRule& rule_;
    CellGrid grid_;
    Cover covered_;
    Reads reads_;
    Joins joins_;
    std::array<std::size_t, Reads::most> pixel_;
};

void lookup_blocks(std::span<const DeepLevel> levels, const LookupRule& rule, std::span<const Query> queries,
                   std::span<float> visibility) {
    BlockLookup blocks(levels[0], rule);
    Lookup<1, BinarySearch, InMemory> others(InMemory{levels}, rule);
    for (std::size_t start = 0; start < queries.size(); start += block_queries) {
        const std::span<const Query> block = queries.subspan(start, std::min(block_queries, queries.size() - start));
        const std::span<float> answers = visibility.subspan(start, block.size());
        if (!blocks.run(block, answers)) others.run(block, answers);
    }
}

}  // namespace

void lookup(std::span<const DeepLevel> levels, const LookupRule& rule, std::span<const Query> queries,
            std::span<const Footprint> footprints, std::span<float> visibility) {
    if (levels[0].channels == 3)
        return lookup_channels<3>(InMemory{levels}, rule, queries, footprints, visibility);
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
