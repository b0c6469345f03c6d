// Several depths per cell and a test with several outcomes: Pagot, Comba, Oliveira, Multiple-Depth Shadow Maps, 2004.
#include <limits>
#include <utility>

#include "techniques/multi_depth/select_depths.h"
#include "techniques/store/depth_map.h"

namespace shadowbench::techniques {
namespace {

// Defaults: the 3-SM with a kernel of 3 x 3 of the paper's figures 1, 6 and 7, with its q = 9 of section 6.
const Parameter parameters[] = {
    {"n", ParameterKind::integer, "depths per cell", 3, 1, most_depths},
    {"select",
     ParameterKind::choice,
     "the depths kept beside the cell's own: the n - 1 deepest or nearest of the q samples, half of each, or the "
     "middles of n groups of the sorted samples",
     0,
     0,
     0,
     "both",
     {"maximum", "minimum", "both", "sorted"}},
    {"q", ParameterKind::integer, "samples of the base map around a cell, including its own; 9, 25 and 49 are squares",
     9, 1, 289},
    {"kernel", ParameterKind::integer, "cells along each side of a lookup's kernel, k = kernel^2 in PCF(k, n)", 3, 1,
     16},
    {"region",
     ParameterKind::choice,
     "the region of the kernel: adjacent cells, where cells outside the map are lit, or positions spread evenly over "
     "the part of the query's footprint inside the map",
     0,
     0,
     0,
     "cells",
     {"cells", "query"}},
    {"bias", ParameterKind::number, "added to every stored depth, world length", 0.0, 0.0, 1e6},
    cells_parameter,
    storage_parameter,
};

Selection read_selection(const ParameterValues& values) {
    const std::string& word = values.word("select");
    if (word == "maximum") return Selection::maximum;
    if (word == "minimum") return Selection::minimum;
    return word == "both" ? Selection::both : Selection::sorted;
}

class MultiDepth final : public Map {
public:
    explicit MultiDepth(const ParameterValues& v)
        : n_(v.integer("n")),
          q_(v.integer("q")),
          side_(v.integer("kernel")),
          selection_(read_selection(v)),
          spread_(v.word("region") == "query"),
          bias_(static_cast<float>(v.number("bias"))),
          way_(read_storage(v)) {
        base_.kind = read_cells(v);
    }

    void begin(const BuildInput& input) override { base_.begin(input.layout); }
    void add(const rays::LightRays& tile) override { base_.add(tile); }
    // The base map is complete now, so search regions may cross the borders of tiles.
    void finish() override {
        const std::vector<float> base = std::exchange(base_.depth, {});
        store_.keep(way_, base_.grid, n_, select_all(selection_, q_, n_, base_.grid, base));
    }
    void set_lookups(const ParameterValues& values) override { side_ = values.integer("kernel"); }

    void lookup(std::span<const Query> queries, std::span<float> visibility) const override {
        const float outcomes = static_cast<float>(side_ * side_ * n_);
        store_.read([&](const auto& depths) {
            for (std::size_t i = 0; i < queries.size(); ++i) {
                Kernel kernel;
                visibility[i] = 1.0f;
                if (find(queries[i], kernel))
                    visibility[i] -= static_cast<float>(count_shadowed(depths, kernel, queries[i].z)) / outcomes;
            }
        });
    }

    void touched(const Query& q, std::vector<const void*>& lines) const override {
        Kernel kernel;
        if (!find(q, kernel)) return;
        const std::size_t before = lines.size();
        store_.read([&](const auto& depths) {
            if constexpr (std::decay_t<decltype(depths)>::bounded) depths.touch_bounds(kernel.range(), lines);
            if (known(depths, kernel, q.z) < 0) kernel.for_each([&](int x, int y) { depths.touch(x, y, lines); });
        });
        keep_unique(lines, before);
    }

    std::size_t bytes() const override { return store_.bytes(); }
    std::size_t working_bytes() const override {
        const std::size_t base = base_.grid.count() * sizeof(float);
        const std::size_t chosen = base * static_cast<std::size_t>(n_);
        return base + chosen + (way_ == Storage::raw ? 0 : store_.bytes());
    }
    NodeStats nodes() const override { return store_.nodes(); }
    Cells cells() const override { return base_.kind; }
    void stored(int x, int y, int, std::span<const float>, curves::Curve& out) const override {
        steps_of(store_.at(x, y), n_, out);
    }

private:
    // The cells of one lookup inside the map: column[0, columns) x row[0, rows), ascending.
    struct Kernel {
        int columns = 0, rows = 0;
        int column[16], row[16];

        CellRange range() const { return {column[0], column[columns - 1] + 1, row[0], row[rows - 1] + 1}; }
        template <class Visit>
        void for_each(const Visit& visit) const {
            for (int j = 0; j < rows; ++j)
                for (int i = 0; i < columns; ++i) visit(column[i], row[j]);
        }
    };

    // A regular grid of side x side positions: adjacent cells around the lookup's own, without those outside the map;
    // or the middles of equal parts of the footprint's area inside the map. Returns false outside the map, which is
    // lit.
    bool find(const Query& q, Kernel& kernel) const {
        const CellGrid& grid = store_.grid();
        int x, y;
        if (!grid.find(q.x, q.y, x, y)) return false;
        const auto line = [&](double middle, double per_pixel, int cells, int* places) {
            middle *= per_pixel;
            double first = middle - 0.5 * (side_ - 1), step = 1.0;
            if (spread_) {
                const double half = 0.5 * width_of(q) * per_pixel;
                const double low = std::max(middle - half, 0.0), high = std::min<double>(middle + half, cells);
                step = (high - low) / side_;
                first = low + 0.5 * step;
            }
            int count = 0;
            for (int i = 0; i < side_; ++i) {
                const double at = first + i * step;
                if (at >= 0.0 && at < cells) places[count++] = static_cast<int>(at);
            }
            return count;
        };
        kernel.columns = line(q.x, grid.per_pixel_x, grid.width, kernel.column);
        kernel.rows = line(q.y, grid.per_pixel_y, grid.height, kernel.row);
        return kernel.columns > 0 && kernel.rows > 0;
    }

    // The sum of the n-shadow-tests' numerators if the bounds determine it; else -1.
    template <class Depths>
    int known(const Depths& depths, const Kernel& kernel, float z) const {
        if constexpr (Depths::bounded) {
            const DepthBounds bounds = depths.bounds(kernel.range());
            if (!(z > bounds.least + bias_)) return 0;
            if (z > bounds.greatest + bias_) return kernel.columns * kernel.rows * n_;
        }
        return -1;
    }

    // Cells outside the map are lit.
    template <class Depths>
    int count_shadowed(const Depths& depths, const Kernel& kernel, float z) const {
        if (const int sum = known(depths, kernel, z); sum >= 0) return sum;
        const auto count = [&](const auto& read) {
            int sum = 0;
            kernel.for_each([&](int x, int y) {
                const float* depth = read.at(x, y);
                for (int i = 0; i < n_; ++i) sum += z > depth[i] + bias_;
            });
            return sum;
        };
        if (DepthWindow window; depths.window(kernel.range(), window)) return count(window);
        return count(depths);
    }

    int n_, q_, side_;
    Selection selection_;
    bool spread_;
    float bias_;
    Storage way_;
    DepthMap base_;  // its depths are freed when the map is finished
    DepthStore store_;
};

// `region=cells` is a filter of a fixed number of cells: it would depend on the map's resolution. Not traded: `q`,
// whose neighbours are cells too; `select` maximum and minimum, which make every shadow smaller or larger; `bias` and
// `cells`, for the reasons of shadow_map.
std::vector<Trade> multi_depth_trades() {
    return {{"n", Trade::Scale::linear, 1, most_depths},
            {"kernel", Trade::Scale::linear, 1, 16, {}, true},
            {.parameter = "select", .choices = {"both", "sorted"}},
            {.parameter = "region", .choices = {"query"}},
            storage_trade};
}

}  // namespace

Technique multi_depth() {
    return {.id = "multi_depth",
            .title = "several depths a cell, and a shadow test with as many steps",
            .paper = "Pagot, Comba, Oliveira 2004",
            .version = 2,
            .promises = {.opaque_only = true},
            .parameters = parameters,
            .create = create_map<MultiDepth>,
            // With more depths than its own, a cell also represents its neighbours: there is no bound on the error
            // against its ray.
            .error_bound =
                [](const ParameterValues& values, const rays::MapLayout& layout) {
                    const bool own = values.integer("n") == 1 || values.integer("q") == 1;
                    return own ? 0.0 : no_bound(values, layout);
                },
            .least_bytes =
                [](const ParameterValues& values, const rays::MapLayout& layout) {
                    return least_store_bytes(read_storage(values), make_cells(layout, read_cells(values)),
                                             values.integer("n"));
                },
            // A lookup answers one minus a count divided by its number; the function holds the remaining count divided
            // by it.
            .traits = {.beyond_footprint = true,
                       .filters = false,
                       .lookup_rounding = 1e-7,
                       .biases = {"bias"},
                       .pointwise = {{"kernel", 1.0}},
                       .trades = multi_depth_trades()}};
}

}  // namespace shadowbench::techniques
