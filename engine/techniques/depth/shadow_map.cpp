#include "techniques/depth/depth.h"
#include "techniques/depth_map.h"

namespace shadowbench::techniques {
namespace {

const Parameter parameters[] = {
    {"bias", ParameterKind::number, "added to every stored depth, world length", 0.0, 0.0, 1e6},
    cells_parameter,
    storage_parameter,
};

class ShadowMap final : public Map {
public:
    explicit ShadowMap(const ParameterValues& values)
        : bias_(static_cast<float>(values.number("bias"))), depths_(values) {}

    void begin(const BuildInput& input) override { depths_.map.begin(input.layout); }
    void add(const rays::LightRays& tile) override { depths_.map.add(tile); }
    void finish() override { depths_.finish(); }

    void lookup(std::span<const Query> queries, std::span<float> visibility) const override {
        depths_.store.read([&](const auto& depths) {
            for (std::size_t i = 0; i < queries.size(); ++i) {
                const Query& q = queries[i];
                int x, y;
                visibility[i] = grid().find(q.x, q.y, x, y) && shadowed(depths, x, y, q.z) ? 0.0f : 1.0f;
            }
        });
    }
    void touched(const Query& q, std::vector<const void*>& lines) const override {
        int x, y;
        if (!grid().find(q.x, q.y, x, y)) return;
        const std::size_t before = lines.size();
        depths_.store.read([&](const auto& depths) {
            if constexpr (std::decay_t<decltype(depths)>::bounded) {
                depths.touch_bounds({x, x + 1, y, y + 1}, lines);
                const DepthBounds bounds = depths.bounds(x, y);
                if (!(q.z > bounds.least + bias_) || q.z > bounds.greatest + bias_) return;
            }
            depths.touch(x, y, lines);
        });
        keep_unique(lines, before);
    }

    std::size_t bytes() const override { return depths_.store.bytes(); }
    std::size_t working_bytes() const override { return depths_.working_bytes(); }
    NodeStats nodes() const override { return depths_.store.nodes(); }
    Cells cells() const override { return depths_.map.kind; }
    void stored(int x, int y, int, std::span<const float>, curves::Curve& out) const override {
        depths_.stored(x, y, out);
    }

private:
    const CellGrid& grid() const { return depths_.store.grid(); }

    template <class Depths>
    bool shadowed(const Depths& depths, int x, int y, float z) const {
        if constexpr (Depths::bounded) {
            const DepthBounds bounds = depths.bounds(x, y);
            if (!(z > bounds.least + bias_)) return false;
            if (z > bounds.greatest + bias_) return true;
        }
        return z > *depths.at(x, y) + bias_;
    }

    float bias_;
    StoredDepths depths_;
};

}  // namespace

Technique shadow_map() {
    return {"shadow_map",
            "z-buffer shadow map, nearest cell",
            "Williams 1978",
            1,
            {.opaque_only = true},
            parameters,
            [](const ParameterValues& values) -> std::unique_ptr<Map> { return std::make_unique<ShadowMap>(values); },
            [](const ParameterValues&, const rays::MapLayout&) { return 0.0; },
            nullptr,
            [](const ParameterValues& values, const rays::MapLayout& layout) {
                return least_store_bytes(read_storage(values), make_cells(layout, read_cells(values)), 1);
            }};
}

}  // namespace shadowbench::techniques
