// Maps of one texel for each ray, all of the same number of floats: their memory, and the filters of lookups. Each
// technique defines the content and evaluation of its texels.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include "techniques/store/cells.h"
#include "techniques/store/reads.h"

namespace shadowbench::techniques {

enum class Filter { point, bilinear, footprint };

inline const Parameter filter_parameter{"filter",
                                        ParameterKind::choice,
                                        "texels of a lookup: the nearest, four bilinearly, or all that the query's "
                                        "footprint covers, each by the part of it "
                                        "that is covered",
                                        0,
                                        0,
                                        0,
                                        "footprint",
                                        {"point", "bilinear", "footprint"}};
inline const Trade filter_trade{
    .parameter = "filter", .choices = {"footprint", "bilinear", "point"}, .only_lookups = true};
inline Filter read_filter(const ParameterValues& values) {
    const std::string& word = values.word("filter");
    return word == "point" ? Filter::point : word == "bilinear" ? Filter::bilinear : Filter::footprint;
}

// Calls visit(x, y, weight) for the four cells around a position in the map, with their bilinear weights; at the border
// the outermost cells repeat.
template <class Visit>
void for_each_of_four(const CellGrid& grid, const Query& q, const Visit& visit) {
    const float fx = q.x * grid.per_pixel_x - 0.5f, fy = q.y * grid.per_pixel_y - 0.5f;
    const int x0 = static_cast<int>(std::floor(fx)), y0 = static_cast<int>(std::floor(fy));
    const float wx = fx - static_cast<float>(x0), wy = fy - static_cast<float>(y0);
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i)
            visit(std::clamp(x0 + i, 0, grid.width - 1), std::clamp(y0 + j, 0, grid.height - 1),
                  (i ? wx : 1.0f - wx) * (j ? wy : 1.0f - wy));
}

// Texels row after row, without gaps, from the start of a cache line on.
struct Texels {
    Cells kind = Cells::sample;
    Filter filter = Filter::footprint;
    CellGrid grid;
    int stride = 0;        // floats per texel
    float highest = 1.0f;  // limit of the answers: rounding must not lift a mean above its values

    explicit Texels(const ParameterValues& values) : kind(read_cells(values)), filter(read_filter(values)) {}

    // The memory is not cleared: the thread that builds a texel writes it once.
    void allocate(const rays::MapLayout& layout, int floats_a_texel) {
        grid = make_cells(layout, kind);
        stride = floats_a_texel;
        memory_.reset(static_cast<float*>(::operator new[](bytes(), std::align_val_t{64})));
    }
    static std::size_t bytes(const ParameterValues& values, const rays::MapLayout& layout, int floats_a_texel) {
        return make_cells(layout, read_cells(values)).count() * sizeof(float) * floats_a_texel;
    }
    std::size_t bytes() const { return grid.count() * sizeof(float) * stride; }
    float* at(std::size_t cell) const { return memory_.get() + cell * stride; }

    // visibility[i]: the weighted mean, over the texels of queries[i]'s filter, of the values that `evaluate` gives
    // them. Lookups go in blocks: all texels of a block are prefetched first, so that their misses overlap, and
    // evaluated side by side. For each block, prepare(queries) is called first; then evaluate(reads), once or more
    // often, sets reads.value from reads.texel and reads.query.
    template <class Prepare, class Evaluate>
    void lookup(std::span<const Query> queries, std::span<float> visibility, const Prepare& prepare,
                const Evaluate& evaluate) const {
        Reads reads;
        Cover covered;
        // Over up to millions of texels: float sums would stop growing.
        std::array<double, block_queries> sums, weights;
        for (std::size_t start = 0; start < queries.size(); start += block_queries) {
            const std::span<const Query> block =
                queries.subspan(start, std::min(block_queries, queries.size() - start));
            const std::span<float> answers = visibility.subspan(start, block.size());
            prepare(block);
            if (read_slots(block, covered, reads)) {
                evaluate(reads);
                average(reads, covered.inside, highest, answers);
                continue;
            }
            sums.fill(0.0);
            weights.fill(0.0);
            read(block, covered, reads, [&] {
                evaluate(reads);
                for (std::size_t r = 0; r < reads.count; ++r) {
                    sums[reads.query[r]] += reads.weight[r] * reads.value[r];
                    weights[reads.query[r]] += reads.weight[r];
                }
            });
            for (std::size_t k = 0; k < block.size(); ++k)
                answers[k] = covered.inside[k] ? std::min(static_cast<float>(sums[k] / weights[k]), highest) : 1.0f;
        }
    }

    // visibility[i]: evaluate(means, prepare(z)), where `means` are the weighted means, in double, of the first `count`
    // floats over the texels of queries[i]'s filter. For values that can be averaged before they are evaluated.
    template <int count, class Prepare, class Evaluate>
    void lookup_means(std::span<const Query> queries, std::span<float> visibility, const Prepare& prepare,
                      const Evaluate& evaluate) const {
        Reads reads;
        Cover covered;
        std::array<std::array<double, count>, block_queries> means;
        std::array<double, block_queries> weights;
        for (std::size_t start = 0; start < queries.size(); start += block_queries) {
            const std::span<const Query> block =
                queries.subspan(start, std::min(block_queries, queries.size() - start));
            for (std::array<double, count>& mean : means) mean.fill(0.0);
            weights.fill(0.0);
            const auto add = [&] {
                for (std::size_t r = 0; r < reads.count; ++r) {
                    const std::size_t k = reads.query[r];
                    for (int i = 0; i < count; ++i) means[k][i] += reads.weight[r] * reads.texel[r][i];
                    weights[k] += reads.weight[r];
                }
            };
            if (read_slots(block, covered, reads))
                add();
            else
                read(block, covered, reads, add);
            for (std::size_t k = 0; k < block.size(); ++k) {
                visibility[start + k] = 1.0f;
                if (!covered.inside[k]) continue;
                for (double& mean : means[k]) mean /= weights[k];
                visibility[start + k] = evaluate(means[k].data(), prepare(block[k].z));
            }
        }
    }

    // Calls visit(cell, weight) for the texels of a query's filter; for none outside the map.
    template <class Visit>
    void for_each(const Query& q, const Visit& visit) const {
        int cx, cy;
        if (!grid.find(q.x, q.y, cx, cy)) return;
        if (filter == Filter::footprint)
            return for_each_covered(grid, q, [&](int x, int y, double weight) { visit(grid.index(x, y), weight); });
        if (filter == Filter::point) return visit(grid.index(cx, cy), 1.0);
        for_each_of_four(grid, q, [&](int x, int y, float weight) { visit(grid.index(x, y), weight); });
    }

private:
    // Arranges the reads of a block in slots, and prefetches them. Returns false if a query has too many texels for
    // that, or if the block is so short that its empty places would take longer; then only `covered` is set.
    bool read_slots(std::span<const Query> block, Cover& covered, Reads& reads) const {
        filter == Filter::footprint ? cover(grid, block, covered) : cover_nearest(grid, block, covered);
        if (block.size() < Reads::fewest_in_slots || covered.across.longest > 2 || covered.down.longest > 2)
            return false;
        if (filter == Filter::point) {
            reads.begin(1);
            std::fill_n(reads.weight.begin(), block_queries, 1.0);
            for (std::size_t k = 0; k < block_queries; ++k)
                put(reads, k, grid.index(covered.across.begin[k], covered.down.begin[k]));
            return true;
        }
        reads.begin(4);
        if (filter == Filter::footprint) {
            set_weights(covered, reads.weight.data());
            CellSlots cells;
            four_cells(covered, grid.width, cells);
            for (std::size_t r = 0; r < reads.count; ++r) put(reads, r, cells[r]);
            return true;
        }
        for (std::size_t k = 0; k < block_queries; ++k) {
            std::size_t slot = k;
            for_each_of_four(grid, k < block.size() && covered.inside[k] ? block[k] : Query{},
                             [&](int x, int y, float weight) {
                                 put(reads, slot, grid.index(x, y));
                                 reads.weight[slot] = weight;
                                 slot += block_queries;
                             });
        }
        return true;
    }
    void put(Reads& reads, std::size_t r, std::size_t cell) const {
        const float* texel = at(cell);
        prefetch_texel(texel, stride);
        reads.texel[r] = texel;
    }

    // Collects the texels of a block's queries in any order, and calls take() whenever `reads` is full and at the end.
    template <class Take>
    void read(std::span<const Query> block, const Cover& covered, Reads& reads, const Take& take) const {
        reads.begin(0);
        const auto add = [&](int x, int y, std::size_t number, double weight) {
            if (reads.full()) {
                take();
                reads.begin(0);
            }
            const float* texel = at(grid.index(x, y));
            prefetch_texel(texel, stride);
            reads.add(texel, number, weight);
        };
        for (std::size_t k = 0; k < block.size(); ++k) {
            if (!covered.inside[k]) continue;
            const auto add_to = [&](int x, int y, double weight) { add(x, y, k, weight); };
            if (filter == Filter::bilinear)
                for_each_of_four(grid, block[k], add_to);
            else
                for_each_of(covered.across[k], covered.down[k], add_to);
        }
        if (reads.count > 0) take();
    }

    struct Free {
        void operator()(float* p) const { ::operator delete[](p, std::align_val_t{64}); }
    };
    std::unique_ptr<float[], Free> memory_;
};

// A function that is not piecewise linear, as vertices: evaluate(z) at its own depths and at the given ones, both
// sorted. `out` is replaced.
template <class Evaluate>
void sample_function(std::span<const float> own, std::span<const float> given, const Evaluate& evaluate,
                     curves::Curve& out) {
    out.clear();
    std::size_t i = 0, k = 0;
    while (i < own.size() || k < given.size()) {
        const bool first = k == given.size() || (i < own.size() && own[i] <= given[k]);
        const float z = first ? own[i++] : given[k++];
        if (out.empty() || out.back().z != z) out.push_back({z, evaluate(z)});
    }
}

}  // namespace shadowbench::techniques
