#include "techniques/avsm/avsm.h"

#include <memory>
#include <new>

#include "techniques/avsm/stream.h"
#include "techniques/avsm/texel.h"
#include "techniques/cells.h"

namespace shadowbench::techniques {
namespace {

const Parameter parameters[] = {
    {"nodes", ParameterKind::integer, "nodes a texel", 8, 2, 64},
    {"filter",
     ParameterKind::choice,
     "texels of a lookup: the nearest, four bilinearly, or all of the query's footprint",
     0,
     0,
     0,
     "footprint",
     {"point", "bilinear", "footprint"}},
    cells_parameter,
};

enum class Filter { point, bilinear, footprint };
Filter read_filter(const ParameterValues& values) {
    const std::string& word = values.word("filter");
    return word == "point" ? Filter::point : word == "bilinear" ? Filter::bilinear : Filter::footprint;
}

// Texels one after the other, each of 2 * nodes floats: depths, then values. Aligned to cache lines.
class Avsm final : public Map {
public:
    explicit Avsm(const ParameterValues& values)
        : nodes_(values.integer("nodes")),
          filter_(read_filter(values)),
          kind_(read_cells(values)),
          evaluate_(texel_evaluator(nodes_)) {}

    Avsm(const ParameterValues& values, std::span<const curves::Curve> functions) : Avsm(values) {
        kind_ = Cells::centre;
        float far_plane = 0.0f;
        for (const curves::Curve& f : functions)
            if (!f.empty()) far_plane = std::max(far_plane, f.back().z);
        far_plane = std::nextafter(far_plane, std::numeric_limits<float>::infinity());
        layout_.width = static_cast<int>(functions.size());
        layout_.z_max = far_plane;
        start();
        with_stream([&](auto& stream) {
            for (std::size_t f = 0; f < functions.size(); ++f) {
                stream.clear(far_plane);
                for (const curves::Vertex& v : functions[f]) stream.append(v.z, v.value);
                store(stream, f);
            }
        });
    }

    void begin(const BuildInput& input) override {
        layout_ = input.layout;
        start();
    }

    void add(const rays::LightRays& rays) override {
        with_stream([&](auto& stream) {
            for_each_cell(layout_, grid_, kind_, rays, [&](std::size_t cell, std::size_t ray) {
                if (rays.begin[ray] == rays.begin[ray + 1]) {
                    store_empty(cell);
                    return;
                }
                stream.clear(layout_.z_max);
                for (std::uint32_t s = rays.begin[ray]; s < rays.begin[ray + 1]; ++s)
                    stream.insert(rays.z_front[s], rays.back(s), rays.transmittance[s]);
                store(stream, cell);
            });
        });
    }
    void finish() override {}

    void lookup(std::span<const Query> queries, std::span<float> visibility) const override {
        if (filter_ == Filter::point) {
            for (std::size_t i = 0; i < queries.size(); ++i) {
                int x, y;
                visibility[i] = grid_.find(queries[i].x, queries[i].y, x, y)
                                    ? evaluate_(texel(grid_.index(x, y)), nodes_, queries[i].z)
                                    : 1.0f;
            }
            return;
        }
        for (std::size_t i = 0; i < queries.size(); ++i) {
            float sum = 0.0f, weights = 0.0f;
            for_each_texel(queries[i], [&](std::size_t cell, float weight) {
                sum += weight * evaluate_(texel(cell), nodes_, queries[i].z);
                weights += weight;
            });
            visibility[i] = weights > 0.0f ? std::min(sum / weights, 1.0f) : 1.0f;
        }
    }

    void touched(const Query& query, std::vector<const void*>& lines) const override {
        const auto touch = [&](std::size_t cell, float) { touch_lines(texel(cell), 8 * nodes_, lines); };
        int x, y;
        if (filter_ != Filter::point)
            for_each_texel(query, touch);
        else if (grid_.find(query.x, query.y, x, y))
            touch(grid_.index(x, y), 1.0f);
    }

    std::size_t bytes() const override { return grid_.count() * 8 * nodes_; }
    std::size_t working_bytes() const override { return bytes() + sizeof(TransmittanceStream<64>); }
    NodeStats nodes() const override {
        NodeStats stats;
        for (std::size_t cell = 0; cell < grid_.count(); ++cell) stats.add(used(cell));
        return stats;
    }
    Cells cells() const override { return kind_; }
    void stored(int x, int y, int, std::span<const float>, curves::Curve& out) const override {
        const std::size_t cell = grid_.index(x, y);
        const float* t = texel(cell);
        out.clear();
        if (const std::uint32_t n = used(cell); n > 1)
            for (std::uint32_t i = 0; i < n; ++i) out.push_back({t[i], t[nodes_ + i]});
    }

private:
    struct Free {
        void operator()(float* p) const { ::operator delete[](p, std::align_val_t{64}); }
    };

    void start() {
        grid_ = make_cells(layout_, kind_);
        texels_.reset(static_cast<float*>(::operator new[](bytes(), std::align_val_t{64})));
    }
    float* texel(std::size_t cell) const { return texels_.get() + cell * 2 * nodes_; }

    void store_empty(std::size_t cell) {
        float* t = texel(cell);
        std::fill_n(t, nodes_, layout_.z_max);
        std::fill_n(t + nodes_, nodes_, 1.0f);
    }

    // Nodes not needed stand at the far plane with the last value.
    template <class Stream>
    void store(const Stream& stream, std::size_t cell) {
        float* t = texel(cell);
        int i = 0;
        stream.for_each([&](float depth, float value) {
            t[i] = depth;
            t[nodes_ + i] = value;
            ++i;
        });
        for (const int last = i - 1; i < nodes_; ++i) {
            t[i] = t[last];
            t[nodes_ + i] = t[nodes_ + last];
        }
    }

    // Calls work(stream) with a stream of the smallest sufficient size.
    template <class Work>
    void with_stream(const Work& work) {
        const auto run = [&]<int size>() {
            TransmittanceStream<size> stream(nodes_, layout_.z_max);
            work(stream);
        };
        if (nodes_ <= 4)
            run.template operator()<4>();
        else if (nodes_ <= 8)
            run.template operator()<8>();
        else if (nodes_ <= 16)
            run.template operator()<16>();
        else
            run.template operator()<64>();
    }

    // Nodes before the far plane and one there; an empty texel has 0.
    std::uint32_t used(std::size_t cell) const {
        const float* t = texel(cell);
        std::uint32_t n = 0;
        while (n < static_cast<std::uint32_t>(nodes_) && t[n] < layout_.z_max) ++n;
        return n == 0 ? 0 : std::min<std::uint32_t>(n + 1, nodes_);
    }

    template <class Visit>
    void for_each_texel(const Query& q, const Visit& visit) const {
        if (filter_ == Filter::footprint) {
            const CellRange r = footprint(grid_, q);
            for (int y = r.y0; y < r.y1; ++y)
                for (int x = r.x0; x < r.x1; ++x) visit(grid_.index(x, y), 1.0f);
            return;
        }
        int cx, cy;
        if (!grid_.find(q.x, q.y, cx, cy)) return;
        const float fx = q.x * grid_.per_pixel_x - 0.5f, fy = q.y * grid_.per_pixel_y - 0.5f;
        const int x0 = static_cast<int>(std::floor(fx)), y0 = static_cast<int>(std::floor(fy));
        const float wx = fx - static_cast<float>(x0), wy = fy - static_cast<float>(y0);
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i)
                visit(grid_.index(std::clamp(x0 + i, 0, grid_.width - 1), std::clamp(y0 + j, 0, grid_.height - 1)),
                      (i ? wx : 1.0f - wx) * (j ? wy : 1.0f - wy));
    }

    int nodes_;
    Filter filter_;
    Cells kind_;
    TexelEvaluator evaluate_;
    rays::MapLayout layout_;
    CellGrid grid_;
    std::unique_ptr<float[], Free> texels_;
};

}  // namespace

Technique avsm() {
    return {"avsm",
            "adaptive volumetric shadow map: a fixed number of nodes a texel",
            "Salvi et al. 2010",
            1,
            {},
            parameters,
            [](const ParameterValues& values) -> std::unique_ptr<Map> { return std::make_unique<Avsm>(values); },
            [](const ParameterValues&, const rays::MapLayout&) { return std::numeric_limits<double>::infinity(); },
            [](const ParameterValues& values, std::span<const curves::Curve> functions) -> std::unique_ptr<Map> {
                return std::make_unique<Avsm>(values, functions);
            },
            [](const ParameterValues& values, const rays::MapLayout& layout) {
                return make_cells(layout, read_cells(values)).count() * 8 * values.integer("nodes");
            }};
}

}  // namespace shadowbench::techniques
