#include "techniques/depth/depth.h"
#include "techniques/depth/depth_map.h"

namespace shadowbench::techniques {
namespace {

const Parameter parameters[] = {
    {"bias", ParameterKind::number, "added to every stored depth, world length", 0.0, 0.0, 1e6},
    cells_parameter,
};

class ShadowMap final : public Map {
public:
    explicit ShadowMap(const ParameterValues& values) : bias_(static_cast<float>(values.number("bias"))) {
        map_.kind = read_cells(values);
    }

    void begin(const BuildInput& input) override { map_.begin(input.layout); }
    void add(const rays::LightRays& tile) override { map_.add(tile); }
    void finish() override {}

    void lookup(std::span<const Query> queries, std::span<float> visibility) const override {
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const Query& q = queries[i];
            int x, y;
            visibility[i] =
                map_.grid.find(q.x, q.y, x, y) && q.z > map_.depth[map_.grid.index(x, y)] + bias_ ? 0.0f : 1.0f;
        }
    }
    void touched(const Query& q, std::vector<const void*>& lines) const override {
        int x, y;
        if (map_.grid.find(q.x, q.y, x, y)) touch_lines(&map_.depth[map_.grid.index(x, y)], sizeof(float), lines);
    }

    std::size_t bytes() const override { return map_.bytes(); }
    std::size_t working_bytes() const override { return map_.bytes(); }
    NodeStats nodes() const override { return map_.nodes(); }
    Cells cells() const override { return map_.kind; }
    void stored(int x, int y, int, std::span<const float>, curves::Curve& out) const override {
        map_.stored(x, y, out);
    }

private:
    DepthMap map_;
    float bias_;
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
                return make_cells(layout, read_cells(values)).count() * sizeof(float);
            }};
}

}  // namespace shadowbench::techniques
