// How a lookup combines functions, wherever they are stored: in memory or in the tiles of a file. Both give the same
// bits. See LookupRule.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "curves/curve.h"
#include "techniques/deep/deep_file.h"
#include "techniques/deep/deep_lookup.h"
#include "techniques/deep/footprint.h"
#include "techniques/deep/probes.h"
#include "techniques/deep/segment_search.h"

namespace shadowbench::techniques {

// The value of a function, where `next` is the first of its n depths that is not less than z.
inline float value_at(const float* depths, const float* values, std::uint32_t n, std::uint32_t next, float z) {
    if (next == 0) return values[0];
    if (next == n) return values[n - 1];
    return curves::join({depths[next - 1], values[next - 1]}, {depths[next], values[next]}, z);
}

// The values at depth z in each channel of a function of n > 0 nodes, one channel or three, with the same bits as
// curves::evaluate.
template <int channels, class SegmentSearch>
inline std::array<float, channels> evaluate(const float* depths, std::uint32_t n, bool coloured, float z,
                                            SegmentSearch& search) {
    const std::uint32_t next = search(depths, n, z);
    std::array<float, channels> values;
    values.fill(value_at(depths, depths + n, n, next, z));
    if constexpr (channels == 3)
        if (coloured)
            for (std::uint32_t c = 1; c < 3; ++c) values[c] = value_at(depths, depths + (1 + c) * n, n, next, z);
    return values;
}

template <int channels>
std::array<float, channels> lit() {
    std::array<float, channels> values;
    values.fill(1.0f);
    return values;
}

// Lookups in a Source, which has: width() and height() of level 0, levels(), at<channels>(level, x, y, z, search) for
// the values of a pixel, and prefetch_offsets(x, y) and prefetch_nodes(x, y) of a pixel of level 0.
template <int channels, class SegmentSearch, class Source>
class Lookup {
public:
    // `searches`: how the search is made.
    template <class... Searches>
    Lookup(const Source& source, const LookupRule& rule, const Searches&... searches)
        : source_(source), rule_(rule), search_(searches...) {}

    void run(std::span<const Query> queries, std::span<float> visibility) {
        // Queries go in blocks: the cache lines of a whole block are prefetched before the first is used, so that their
        // misses overlap. First the offsets, then the nodes that they point to. This pays if a lookup reads few pixels.
        constexpr std::size_t block = 32;
        Few few[block];
        for (std::size_t start = 0; start < queries.size(); start += block) {
            const std::size_t count = std::min(block, queries.size() - start);
            for (std::size_t k = 0; k < count; ++k) {
                few[k] = few_pixels(queries[start + k]);
                for_each_row(few[k], [&](int x, int y) { source_.prefetch_offsets(x, y); });
            }
            for (std::size_t k = 0; k < count; ++k)
                for_each_row(few[k], [&](int x, int y) { source_.prefetch_nodes(x, y); });
            for (std::size_t k = 0; k < count; ++k) {
                const Query& q = queries[start + k];
                const Values values = few[k].any ? average(few[k], q.z) : filter(q);
                for (std::size_t c = 0; c < channels; ++c) visibility[c * queries.size() + start + k] = values[c];
            }
        }
    }

    // Over known footprints; `rule.probes` is above 0.
    void run(std::span<const Query> queries, std::span<const Footprint> footprints, std::span<float> visibility) {
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const Values values = answer(queries[i], footprints[i]);
            for (std::size_t c = 0; c < channels; ++c) visibility[c * queries.size() + i] = values[c];
        }
    }

private:
    using Values = std::array<float, channels>;

    // A footprint of at most 2 x 2 pixels of the map.
    struct Few {
        bool any = false;  // else it is wider, or reads other levels, or is outside the map
        Stretch across, down;
    };

    CellGrid grid() const { return {source_.width(), source_.height(), 1.0f, 1.0f}; }
    bool inside(const Query& q) const {
        int x, y;
        return grid().find(q.x, q.y, x, y);
    }

    Few few_pixels(const Query& q) const {
        int x, y;
        if (rule_.kernel == Kernel::tent || !(width_of(q) <= widest_few(rule_)) || !grid().find(q.x, q.y, x, y))
            return {};
        if (rule_.kernel == Kernel::pixels) return {true, {x, x + 1}, {y, y + 1}};
        const Few few{true, stretch(q.x, width_of(q), source_.width()), stretch(q.y, width_of(q), source_.height())};
        return few.across.end - few.across.begin <= 2 && few.down.end - few.down.begin <= 2 ? few : Few{};
    }

    // Calls visit(x, y) for the first pixel of each row.
    template <class Visit>
    void for_each_row(const Few& few, const Visit& visit) const {
        if (!few.any) return;
        for (int y = few.down.begin; y < few.down.end; ++y) visit(few.across.begin, y);
    }

    Values average(const Few& few, float z) {
        WeightedMean<channels> mean;
        for_each_of(few.across, few.down, [&](int x, int y, double weight) {
            mean.add(source_.template at<channels>(0, x, y, z, search_), weight);
        });
        return mean.value();
    }

    [[gnu::noinline]] Values filter(const Query& q) {
        if (!inside(q)) return lit<channels>();
        return over_levels(q.width, [&](int level) {
            WeightedMean<channels> mean;
            add(level, q, mean);
            return mean.value();
        });
    }

    Values answer(const Query& q, const Footprint& footprint) {
        Probes probes;
        if (!probes_of(footprint, rule_.probes, probes)) return answer(q);
        if (probes.count == 1) return answer({q.x, q.y, q.z, probes.width});
        if (!inside(q)) return lit<channels>();
        return over_levels(probes.width, [&](int level) {
            WeightedMean<channels> mean;
            for_each_probe(
                q, probes, [&](const Query& probe) { return inside(probe); },
                [&](const Query& probe) { add(level, probe, mean); });
            return mean.value();
        });
    }
    Values answer(const Query& q) {
        const Few few = few_pixels(q);
        return few.any ? average(few, q.z) : filter(q);
    }

    // The blend of the levels for this width. average(level) gives the mean over one of them.
    template <class Average>
    Values over_levels(float width, const Average& average) const {
        const LevelChoice choice = choose_levels(rule_, width, source_.levels());
        Values values = average(choice.fine);
        if (choice.coarser <= 0.0f) return values;
        const Values coarser = average(choice.fine + 1);
        for (int c = 0; c < channels; ++c) values[c] += choice.coarser * (coarser[c] - values[c]);
        return values;
    }

    void add(int level, const Query& q, WeightedMean<channels>& mean) {
        for_each_pixel(source_.width(), source_.height(), level, rule_.kernel, q, [&](int x, int y, double weight) {
            mean.add(source_.template at<channels>(level, x, y, q.z, search_), weight);
        });
    }

    Source source_;
    const LookupRule& rule_;
    SegmentSearch search_;
};

template <int channels, class Source>
void lookup_channels(const Source& source, const LookupRule& rule, std::span<const Query> queries,
                     std::span<const Footprint> footprints, std::span<float> visibility) {
    const auto run = [&](auto&& lookups) {
        if (rule.probes > 0 && !footprints.empty())
            lookups.run(queries, footprints, visibility);
        else
            lookups.run(queries, visibility);
    };
    switch (rule.search) {
        case Search::binary:
            return run(Lookup<channels, BinarySearch, Source>(source, rule));
        case Search::linear:
            return run(Lookup<channels, LinearSearch, Source>(source, rule));
        case Search::cached:
            return run(Lookup<channels, CachedSearch, Source>(source, rule, queries.size()));
    }
}

// Calls visit(level, x, y) for every pixel that a lookup reads in a map of this size, which may be more than once.
template <class Visit>
void for_each_read(int width, int height, std::size_t levels, const LookupRule& rule, const Query& q,
                   const Footprint& footprint, const Visit& visit) {
    const auto inside = [&](const Query& query) {
        int x, y;
        return CellGrid{width, height, 1.0f, 1.0f}.find(query.x, query.y, x, y);
    };
    if (!inside(q)) return;
    const auto visit_all = [&](const Query& query) {
        const LevelChoice choice = choose_levels(rule, query.width, levels);
        for (int level = choice.fine; level <= choice.fine + (choice.coarser > 0.0f); ++level)
            for_each_pixel(width, height, level, rule.kernel, query, [&](int x, int y, double) { visit(level, x, y); });
    };
    Probes probes;
    if (rule.probes > 0 && probes_of(footprint, rule.probes, probes))
        for_each_probe(q, probes, inside, visit_all);
    else
        visit_all(q);
}

// Calls touch(address, bytes) for what a search reads of the n depths before it knows the segment.
template <class Touch>
void touch_search(const float* depths, std::uint32_t n, std::uint32_t found, float z, Search search,
                  const Touch& touch) {
    if (search == Search::linear) return touch(depths, std::min(found + 1, n) * sizeof(float));
    while (n > BinarySearch::lanes) {
        const std::uint32_t half = n / 2;
        touch(depths + half - 1, sizeof(float));
        depths += depths[half - 1] < z ? half : 0;
        n -= half;
    }
    touch(depths, n * sizeof(float));
}

// The same for what a lookup at depth z reads of a function.
template <class Touch>
void touch_function(const DeepFunction& f, float z, Search search, const Touch& touch) {
    const std::uint32_t n = f.nodes;
    if (n == 0) return;
    const std::uint32_t next = BinarySearch()(f.depths, n, z);
    touch_search(f.depths, n, next, z, search, touch);
    const std::uint32_t left = next ? next - 1 : 0, right = std::min(next, n - 1);
    const auto rows = static_cast<std::uint32_t>(1 + f.channels);  // one of depths, then one of values a channel
    for (std::uint32_t row = 0; row < rows; ++row) touch(f.depths + row * n + left, (right - left + 1) * sizeof(float));
}

}  // namespace shadowbench::techniques
