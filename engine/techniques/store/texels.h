// Maps of one texel for each ray, all of the same number of floats: their memory, and the filters of lookups. Each
// technique defines the content and evaluation of its texels.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include "techniques/store/cells.h"

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

    // visibility[i]: the weighted mean of evaluate(texel, prepare(z)) over the texels of queries[i]'s filter. prepare
    // computes once for each query what depends only on the depth.
    template <class Prepare, class Evaluate>
    void lookup(std::span<const Query> queries, std::span<float> visibility, const Prepare& prepare,
                const Evaluate& evaluate) const {
        for (std::size_t i = 0; i < queries.size(); ++i) {
            int x, y;
            if (!grid.find(queries[i].x, queries[i].y, x, y)) {
                visibility[i] = 1.0f;
                continue;
            }
            const auto depth = prepare(queries[i].z);
            if (filter == Filter::point) {
                visibility[i] = evaluate(at(grid.index(x, y)), depth);
                continue;
            }
            double sum = 0.0, weights = 0.0;  // over up to millions of texels: float sums would stop growing
            for_each(queries[i], [&](std::size_t cell, double weight) {
                sum += weight * evaluate(at(cell), depth);
                weights += weight;
            });
            visibility[i] = std::min(static_cast<float>(sum / weights), highest);
        }
    }

    // visibility[i]: evaluate(means, prepare(z)), where `means` are the weighted means, in double, of the first `count`
    // floats over the texels of queries[i]'s filter. For values that can be averaged before they are evaluated.
    template <int count, class Prepare, class Evaluate>
    void lookup_means(std::span<const Query> queries, std::span<float> visibility, const Prepare& prepare,
                      const Evaluate& evaluate) const {
        for (std::size_t i = 0; i < queries.size(); ++i) {
            double means[count] = {}, weights = 0.0;
            for_each(queries[i], [&](std::size_t cell, double weight) {
                const float* texel = at(cell);
                for (int k = 0; k < count; ++k) means[k] += weight * texel[k];
                weights += weight;
            });
            if (weights == 0.0) {  // outside the map
                visibility[i] = 1.0f;
                continue;
            }
            for (double& mean : means) mean /= weights;
            visibility[i] = evaluate(means, prepare(queries[i].z));
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
