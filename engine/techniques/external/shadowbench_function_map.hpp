// The map of a technique of one function: see of_function in shadowbench_technique.hpp.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "shadowbench_technique.h"

// Hidden, since two libraries in one program must not share what has the same name in both.
#pragma GCC visibility push(hidden)
namespace shadowbench {

using Vertex = shadowbench_vertex;
using Curve = std::vector<Vertex>;
using Query = shadowbench_query;
using Footprint = shadowbench_footprint;
using Layout = shadowbench_layout;

// The values of the parameters, in the order of their declaration. The function of of_function may read their words
// whenever it is called; a class of its own must copy them in its constructor, since they are gone afterwards.
using Values = std::vector<shadowbench_value>;

// The segments of one ray, sorted by front.
struct Ray {
    const shadowbench_rays* tile;
    std::uint32_t first, last;  // segments [first, last)

    float front(std::uint32_t segment) const { return tile->z_front[segment]; }
    float back(std::uint32_t segment) const { return tile->z_back ? tile->z_back[segment] : front(segment); }
    float transmittance(std::uint32_t segment) const { return tile->transmittance[segment]; }
};

// The rays that the function of one cell stands for.
struct CellRays {
    const shadowbench_rays* tile;
    const Layout* layout;
    std::size_t first, count;  // rays of the tile

    std::size_t size() const { return count; }
    Ray operator[](std::size_t i) const { return {tile, tile->begin[first + i], tile->begin[first + i + 1]}; }
};

// The value of a stored curve at a depth; calls read(vertex) for each vertex that it looks at.
template <class Read>
float evaluate(const Vertex* vertices, std::size_t count, float z, const Read& read) {
    std::size_t low = 0, high = count;  // the first vertex with z <= its depth lies in [low, high]
    while (low < high) {
        const std::size_t middle = low + (high - low) / 2;
        read(vertices + middle);
        if (vertices[middle].z < z)
            low = middle + 1;
        else
            high = middle;
    }
    if (count == 0) return 1.0f;
    const std::size_t nearest = low == count ? low - 1 : low;
    read(vertices + nearest);
    if (low == 0 || low == count) return vertices[nearest].value;
    const Vertex &a = vertices[low - 1], &b = vertices[low];
    read(&a);
    const double share = (static_cast<double>(z) - a.z) / (static_cast<double>(b.z) - a.z);
    return z == b.z ? b.value : static_cast<float>(a.value + (static_cast<double>(b.value) - a.value) * share);
}

// The map of a technique of one function, for cells of one kind. A lookup is the mean over its footprint, weighted
// by area.
template <auto function, int kind>
class FunctionMap {
public:
    FunctionMap(const Values& values, const Layout& layout) : values_(values), layout_(layout) {
        const bool samples = kind == SHADOWBENCH_CELL_SAMPLE;
        words_.reserve(values_.size());  // so that they stay where they are
        for (shadowbench_value& value : values_)
            if (value.word) value.word = words_.emplace_back(value.word).c_str();
        per_x_ = samples ? layout.samples_x : 1;
        per_y_ = samples ? layout.samples_y : 1;
        width_ = layout.width * per_x_;
        height_ = layout.height * per_y_;
        curves_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    }

    // Tiles have different cells, so that threads do not meet.
    void add(const shadowbench_rays& tile) {
        const auto samples = static_cast<std::size_t>(tile.samples);
        const std::size_t middle =
            static_cast<std::size_t>((layout_.samples_y / 2) * layout_.samples_x + layout_.samples_x / 2);
        for (int y = 0; y < tile.height * per_y_; ++y)
            for (int x = 0; x < tile.width * per_x_; ++x) {
                std::size_t first = (static_cast<std::size_t>(y / per_y_) * static_cast<std::size_t>(tile.width) +
                                     static_cast<std::size_t>(x / per_x_)) *
                                    samples;
                if (kind == SHADOWBENCH_CELL_CENTRE) first += middle;
                if (kind == SHADOWBENCH_CELL_SAMPLE)
                    first += static_cast<std::size_t>(y % per_y_ * per_x_ + x % per_x_);
                const std::size_t count = kind == SHADOWBENCH_CELL_PIXEL ? samples : 1;
                Curve curve = function({&tile, &layout_, first, count}, values_);
                building_ += curve.size() * sizeof(Vertex);
                curve.shrink_to_fit();
                curves_[cell(tile.x0 * per_x_ + x, tile.y0 * per_y_ + y)] = std::move(curve);
            }
    }

    // All curves, one behind the other.
    void finish() {
        building_ += curves_.size() * sizeof(Curve);
        begin_.reserve(curves_.size() + 1);
        begin_.push_back(0);
        std::size_t all = 0;
        for (const Curve& curve : curves_) begin_.push_back(all += curve.size());
        vertices_.reserve(all);
        for (const Curve& curve : curves_) vertices_.insert(vertices_.end(), curve.begin(), curve.end());
        building_ += held();
        std::vector<Curve>().swap(curves_);  // assigning {} would keep its memory
    }

    void lookup(const Query* queries, const Footprint*, std::size_t count, float* visibility) const {
        for (std::size_t i = 0; i < count; ++i) visibility[i] = answer(queries[i], [](const void*) {});
    }
    void touched(const Query& query, const Footprint*, std::vector<const void*>& lines) const {
        answer(query, [&](const void* at) { lines.push_back(at); });
    }
    std::uint64_t held() const { return begin_.size() * sizeof(std::size_t) + vertices_.size() * sizeof(Vertex); }
    std::uint64_t working() const { return building_; }
    std::uint32_t nodes(int x, int y) const {
        return static_cast<std::uint32_t>(begin_[cell(x, y) + 1] - begin_[cell(x, y)]);
    }
    Curve stored(int x, int y, const float*, std::size_t) const {
        return {vertices_.begin() + static_cast<std::ptrdiff_t>(begin_[cell(x, y)]),
                vertices_.begin() + static_cast<std::ptrdiff_t>(begin_[cell(x, y) + 1])};
    }

private:
    std::size_t cell(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }

    // The cells of a footprint along one side, at least the one that holds its middle.
    struct Side {
        int begin, end;
        double low, high;
        double weight(int i) const { return std::min<double>(i + 1, high) - std::max<double>(i, low); }
    };
    static Side side(double middle, double width, int cells) {
        const double low = std::max(middle - 0.5 * width, 0.0), high = std::min<double>(middle + 0.5 * width, cells);
        const int nearest = static_cast<int>(middle);
        if (!(low < high)) return {nearest, nearest + 1, double(nearest), nearest + 1.0};
        return {static_cast<int>(low), static_cast<int>(std::ceil(high)), low, high};
    }

    // Calls read(address) for each vertex and offset that is read.
    template <class Read>
    float answer(const Query& q, const Read& read) const {
        const double x = static_cast<double>(q.x) * per_x_, y = static_cast<double>(q.y) * per_y_;
        if (!(x >= 0.0 && y >= 0.0 && x < width_ && y < height_)) return 1.0f;
        const double width = q.width > 0.0f ? static_cast<double>(q.width) : 0.0;
        const Side across = side(x, width * per_x_, width_), down = side(y, width * per_y_, height_);
        double sum = 0.0, weights = 0.0;
        for (int j = down.begin; j < down.end; ++j)
            for (int i = across.begin; i < across.end; ++i) {
                const double weight = across.weight(i) * down.weight(j);
                const std::size_t* offsets = begin_.data() + cell(i, j);
                read(offsets);
                read(offsets + 1);
                sum += weight * evaluate(vertices_.data() + offsets[0], offsets[1] - offsets[0], q.z, read);
                weights += weight;
            }
        return static_cast<float>(sum / weights);
    }

    std::vector<std::string> words_;  // of values_
    Values values_;
    Layout layout_;
    int per_x_ = 1, per_y_ = 1, width_ = 1, height_ = 1;
    std::vector<Curve> curves_;  // while building
    std::vector<std::size_t> begin_;
    std::vector<Vertex> vertices_;
    std::atomic<std::uint64_t> building_ = 0;
};

}  // namespace shadowbench
#pragma GCC visibility pop
