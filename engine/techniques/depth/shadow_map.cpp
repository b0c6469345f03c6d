// The plain shadow map: Williams, Casting Curved Shadows on Curved Surfaces, 1978.
#include "techniques/store/depth_map.h"

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

    // Reads the one cell directly: checking its tile's bounds first costs more, since its branches mispredict.
    void lookup(std::span<const Query> queries, std::span<float> visibility) const override {
        depths_.store.read([&](const auto& depths) {
            for (std::size_t i = 0; i < queries.size(); ++i) {
                const Query& q = queries[i];
                int x, y;
                visibility[i] = grid().find(q.x, q.y, x, y) && q.z > *depths.at(x, y) + bias_ ? 0.0f : 1.0f;
            }
        });
    }
    void touched(const Query& q, std::vector<const void*>& lines) const override {
        int x, y;
        if (!grid().find(q.x, q.y, x, y)) return;
        depths_.store.read([&](const auto& depths) { depths.touch(x, y, lines); });
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

    float bias_;
    StoredDepths depths_;
};

}  // namespace

Technique shadow_map() {
    return {.id = "shadow_map",
            .title = "z-buffer shadow map, nearest cell",
            .paper = "Williams 1978",
            .version = 1,
            .promises = {.opaque_only = true},
            .parameters = parameters,
            .create = create_map<ShadowMap>,
            .error_bound = [](const ParameterValues&, const rays::MapLayout&) { return 0.0; },
            .least_bytes = StoredDepths::least_bytes,
            // Not traded: `bias`, which costs nothing, and `cells`, since a cell for each sample is a finer map of
            // one sample.
            .traits = {.filters = false, .biases = {"bias"}, .trades = {storage_trade}}};
}

}  // namespace shadowbench::techniques
