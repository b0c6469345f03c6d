#include "techniques/deep/deep_lookup.h"

#include "curves/curve.h"
#include "techniques/deep/footprint.h"

namespace shadowbench::techniques {
namespace {

// The value of a function, where `next` is the first of its n depths that is not less than z.
inline float value_at(const float* depths, const float* values, std::uint32_t n, std::uint32_t next, float z) {
    if (next == 0) return values[0];
    if (next == n) return values[n - 1];
    return curves::join({depths[next - 1], values[next - 1]}, {depths[next], values[next]}, z);
}

// The values of a pixel at depth z in each channel, with the same bits as curves::evaluate.
template <int channels, class SegmentSearch>
inline std::array<float, channels> evaluate(const DeepLevel& level, std::size_t pixel, float z, SegmentSearch& search) {
    const std::uint32_t begin = level.offsets[pixel], size = level.offsets[pixel + 1] - begin;
    const float* const depths = level.floats.data() + begin;
    if constexpr (channels == 1) {
        if (size == 0) return {1.0f};
        const std::uint32_t n = size / 2;
        return {value_at(depths, depths + n, n, search(depths, n, z), z)};
    } else {
        if (size == 0) return {1.0f, 1.0f, 1.0f};
        const bool coloured = level.has_colour(pixel);
        const std::uint32_t n = size / (coloured ? 4 : 2), next = search(depths, n, z);
        const float first = value_at(depths, depths + n, n, next, z);
        if (!coloured) return {first, first, first};
        return {first, value_at(depths, depths + 2 * n, n, next, z), value_at(depths, depths + 3 * n, n, next, z)};
    }
}

template <int channels, class SegmentSearch>
class Lookup {
public:
    Lookup(std::span<const DeepLevel> levels, const LookupRule& rule, SegmentSearch search)
        : levels_(levels), rule_(rule), search_(search) {}

    void run(std::span<const Query> queries, std::span<float> visibility) {
        // Queries go in blocks: the cache lines of a whole block are prefetched before the first is used, so that their
        // misses overlap. First the offsets, then the nodes that they point to. This pays if a lookup reads few pixels.
        constexpr std::size_t block = 32;
        Few few[block];
        for (std::size_t start = 0; start < queries.size(); start += block) {
            const std::size_t count = std::min(block, queries.size() - start);
            for (std::size_t k = 0; k < count; ++k) {
                few[k] = few_pixels(queries[start + k]);
                for_each_row(few[k], [&](std::size_t first) { __builtin_prefetch(&levels_[0].offsets[first]); });
            }
            for (std::size_t k = 0; k < count; ++k)
                for_each_row(few[k], [&](std::size_t first) {
                    const float* nodes = levels_[0].floats.data() + levels_[0].offsets[first];
                    __builtin_prefetch(nodes);
                    __builtin_prefetch(nodes + 16);
                });
            for (std::size_t k = 0; k < count; ++k) {
                const Query& q = queries[start + k];
                const Values values = few[k].any ? average(few[k], q.z) : filter(q);
                for (std::size_t c = 0; c < channels; ++c) visibility[c * queries.size() + start + k] = values[c];
            }
        }
    }

private:
    using Values = std::array<float, channels>;

    // A footprint of at most 2 x 2 pixels of the map.
    struct Few {
        bool any = false;  // else it is wider, or reads other levels, or is outside the map
        Stretch across, down;
    };

    Few few_pixels(const Query& q) const {
        const DeepLevel& map = levels_[0];
        int x, y;
        const float widest = rule_.mip == Mip::none ? 2.0f : narrowest_mip(rule_);
        if (rule_.kernel == Kernel::tent || !(width_of(q) <= widest) || !grid_of(map).find(q.x, q.y, x, y)) return {};
        if (rule_.kernel == Kernel::pixels) {
            // A footprint of a pixel's width includes the nearest pixel, whose centre is within half of that.
            if (width_of(q) > 1.0f) return {};
            return {true, {x, x + 1}, {y, y + 1}};
        }
        const Few few{true, stretch(q.x, width_of(q), map.width), stretch(q.y, width_of(q), map.height)};
        return few.across.end - few.across.begin <= 2 && few.down.end - few.down.begin <= 2 ? few : Few{};
    }

    // Calls visit(pixel) for the first pixel of each row.
    template <class Visit>
    void for_each_row(const Few& few, const Visit& visit) const {
        if (!few.any) return;
        for (int y = few.down.begin; y < few.down.end; ++y) visit(levels_[0].pixel(few.across.begin, y));
    }

    Values average(const Few& few, float z) {
        WeightedMean<channels> mean;
        for_each_of(few.across, few.down, [&](int x, int y, double weight) {
            mean.add(evaluate<channels>(levels_[0], levels_[0].pixel(x, y), z, search_), weight);
        });
        return mean.value();
    }

    [[gnu::noinline]] Values filter(const Query& q) {
        Values values;
        values.fill(1.0f);
        int x, y;
        if (!grid_of(levels_[0]).find(q.x, q.y, x, y)) return values;
        const LevelChoice choice = choose_levels(rule_, q.width, levels_.size());
        values = average(choice.fine, q);
        if (choice.coarser <= 0.0f) return values;
        const Values coarser = average(choice.fine + 1, q);
        for (int c = 0; c < channels; ++c) values[c] += choice.coarser * (coarser[c] - values[c]);
        return values;
    }

    Values average(int level, const Query& q) {
        WeightedMean<channels> mean;
        for_each_pixel(levels_, level, rule_, q, [&](std::size_t pixel, double weight) {
            mean.add(evaluate<channels>(levels_[static_cast<std::size_t>(level)], pixel, q.z, search_), weight);
        });
        return mean.value();
    }

    std::span<const DeepLevel> levels_;
    const LookupRule& rule_;
    SegmentSearch search_;
};

template <int channels>
void lookup_channels(std::span<const DeepLevel> levels, const LookupRule& rule, std::span<const Query> queries,
                     std::span<float> visibility) {
    switch (rule.search) {
        case Search::binary:
            return Lookup<channels, BinarySearch>(levels, rule, {}).run(queries, visibility);
        case Search::linear:
            return Lookup<channels, LinearSearch>(levels, rule, {}).run(queries, visibility);
        case Search::cached:
            return Lookup<channels, CachedSearch>(levels, rule, CachedSearch(queries.size())).run(queries, visibility);
    }
}

// The depths that a search reads before it knows the segment.
void touch_search(const float* depths, std::uint32_t n, std::uint32_t found, float z, Search search,
                  std::vector<const void*>& lines) {
    if (search == Search::linear) return touch_lines(depths, std::min(found + 1, n) * sizeof(float), lines);
    while (n > BinarySearch::lanes) {
        const std::uint32_t half = n / 2;
        touch_lines(depths + half - 1, sizeof(float), lines);
        depths += depths[half - 1] < z ? half : 0;
        n -= half;
    }
    touch_lines(depths, n * sizeof(float), lines);
}

void touch_pixel(const DeepLevel& level, std::size_t p, float z, Search search, std::vector<const void*>& lines) {
    touch_lines(&level.offsets[p], 2 * sizeof(std::uint32_t), lines);
    if (!level.coloured.empty()) touch_lines(&level.coloured[p / 64], sizeof(std::uint64_t), lines);
    const std::uint32_t n = level.nodes(p);
    if (n == 0) return;
    const float* depths = level.floats.data() + level.offsets[p];
    const std::uint32_t next = BinarySearch()(depths, n, z);
    touch_search(depths, n, next, z, search, lines);
    const std::uint32_t left = next ? next - 1 : 0, right = std::min(next, n - 1);
    const std::uint32_t rows = level.has_colour(p) ? 4 : 2;  // one row of depths, then one of values for each channel
    for (std::uint32_t row = 0; row < rows; ++row)
        touch_lines(depths + row * n + left, (right - left + 1) * sizeof(float), lines);
}

}  // namespace

void lookup(std::span<const DeepLevel> levels, const LookupRule& rule, std::span<const Query> queries,
            std::span<float> visibility) {
    if (levels[0].channels == 3)
        lookup_channels<3>(levels, rule, queries, visibility);
    else
        lookup_channels<1>(levels, rule, queries, visibility);
}

void touched(std::span<const DeepLevel> levels, const LookupRule& rule, const Query& q,
             std::vector<const void*>& lines) {
    int x, y;
    if (!grid_of(levels[0]).find(q.x, q.y, x, y)) return;
    const std::size_t before = lines.size();
    const LevelChoice choice = choose_levels(rule, q.width, levels.size());
    for (int l = choice.fine; l <= choice.fine + (choice.coarser > 0.0f); ++l)
        for_each_pixel(levels, l, rule, q, [&](std::size_t pixel, double) {
            touch_pixel(levels[static_cast<std::size_t>(l)], pixel, q.z, rule.search, lines);
        });
    keep_unique(lines, before);
}

}  // namespace shadowbench::techniques
