#include <bit>

#include "base/random.h"
#include "techniques/depth/depth.h"
#include "techniques/depth/depth_map.h"

namespace shadowbench::techniques {
namespace {

// Names and defaults of figure 4 of the paper. Its biases of 0.3 and 0.4 are for worlds of 100 units; receivers carry
// the scenario's own bias, so none is added here by default.
const Parameter parameters[] = {
    {"num_samples", ParameterKind::integer, "depths compared in one lookup, about (NumSamples)", 16, 1, 4096},
    {"res_factor", ParameterKind::number, "widens the region (ResFactor); below 1 the map's aliases show", 3, 1, 1000},
    {"min_size", ParameterKind::number, "least half-size of the region in cells (MinSize)", 2, 0, 10000},
    {"min_samples", ParameterKind::integer, "least samples along each side of the region (MinSamples)", 2, 1, 64},
    {"bias0", ParameterKind::number, "least bias of a sample, world length (Bias0)", 0, 0, 1e6},
    {"bias1", ParameterKind::number, "largest bias of a sample, world length (Bias1); at least bias0", 0, 0, 1e6},
    cells_parameter,
};

struct Settings {
    float samples, res_factor, min_size, min_samples, bias0, bias1;
};

// The region of a lookup, in cells, and its partition: figure 4.
struct Region {
    float left, bottom, step_x, step_y;
    int across, along;
};

Region make_region(const Settings& s, const CellGrid& grid, const Query& q) {
    const float half_x = std::max(0.5f * q.width * grid.per_pixel_x * s.res_factor, s.min_size);
    const float half_y = std::max(0.5f * q.width * grid.per_pixel_y * s.res_factor, s.min_size);
    float across, along;
    if (half_x * half_y * 4.0f < s.samples) {  // few cells: about one sample a cell
        across = std::floor(half_x * 2.0f + 0.5f);
        along = std::floor(half_y * 2.0f + 0.5f);
    } else {
        along = std::clamp(std::floor(std::sqrt(half_y * s.samples / half_x) + 0.5f), s.min_samples,
                           std::max(s.samples, s.min_samples));
        across = std::floor(s.samples / along + 0.5f);
    }
    across = std::clamp(across, s.min_samples, std::max(s.samples, s.min_samples));
    along = std::clamp(along, s.min_samples, std::max(s.samples, s.min_samples));
    return {q.x * grid.per_pixel_x - half_x, q.y * grid.per_pixel_y - half_y, 2.0f * half_x / across,
            2.0f * half_y / along,           static_cast<int>(across),        static_cast<int>(along)};
}

class PercentageCloser final : public Map {
public:
    explicit PercentageCloser(const ParameterValues& v)
        : settings_{static_cast<float>(v.number("num_samples")), static_cast<float>(v.number("res_factor")),
                    static_cast<float>(v.number("min_size")),    static_cast<float>(v.number("min_samples")),
                    static_cast<float>(v.number("bias0")),       static_cast<float>(v.number("bias1"))} {
        map_.kind = read_cells(v);
        settings_.bias1 = std::max(settings_.bias0, settings_.bias1);
    }

    void begin(const BuildInput& input) override { map_.begin(input.layout); }
    void add(const rays::LightRays& tile) override { map_.add(tile); }
    void finish() override {}

    void lookup(std::span<const Query> queries, std::span<float> visibility) const override {
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const Query& q = queries[i];
            int shadowed = 0;
            const int samples =
                for_each_sample(q, [&](const float* depth, float bias) { shadowed += q.z > *depth + bias; });
            visibility[i] = samples ? 1.0f - static_cast<float>(shadowed) / static_cast<float>(samples) : 1.0f;
        }
    }
    void touched(const Query& q, std::vector<const void*>& lines) const override {
        for_each_sample(q, [&](const float* depth, float) { touch_lines(depth, sizeof(float), lines); });
    }

    std::size_t bytes() const override { return map_.bytes(); }
    std::size_t working_bytes() const override { return map_.bytes(); }
    NodeStats nodes() const override { return map_.nodes(); }
    Cells cells() const override { return map_.kind; }
    void stored(int x, int y, int, std::span<const float>, curves::Curve& out) const override {
        map_.stored(x, y, out);
    }

private:
    // Calls visit(depth, bias) for the samples inside the map; those outside are lit. Returns how many there are in
    // all. The jitter depends on the query alone. Samples spread over their whole cells of the region: the printed code
    // moves them by half a cell in one direction only, which would shift every shadow.
    template <class Visit>
    int for_each_sample(const Query& q, const Visit& visit) const {
        int cx, cy;
        if (q.z < 0.0f || !map_.grid.find(q.x, q.y, cx, cy)) return 0;
        const Region r = make_region(settings_, map_.grid, q);
        const std::uint64_t key = base::hash(
            static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(q.x)) << 32 | std::bit_cast<std::uint32_t>(q.y),
            std::bit_cast<std::uint32_t>(q.z));
        std::uint64_t sample = 0;
        for (int j = 0; j < r.along; ++j)
            for (int i = 0; i < r.across; ++i, ++sample) {
                const std::uint64_t bits = base::mix(key + sample);
                const auto uniform = [&](int shift) {
                    return static_cast<float>((bits >> shift) & 0x1fffff) * 0x1p-21f;
                };
                const float fx = r.left + (static_cast<float>(i) + uniform(0)) * r.step_x;
                const float fy = r.bottom + (static_cast<float>(j) + uniform(21)) * r.step_y;
                if (!(fx >= 0.0f && fy >= 0.0f && fx < static_cast<float>(map_.grid.width) &&
                      fy < static_cast<float>(map_.grid.height)))
                    continue;
                const float bias = settings_.bias0 + uniform(42) * (settings_.bias1 - settings_.bias0);
                visit(&map_.depth[map_.grid.index(static_cast<int>(fx), static_cast<int>(fy))], bias);
            }
        return r.across * r.along;
    }

    DepthMap map_;
    Settings settings_;
};

}  // namespace

Technique pcf() {
    return {"pcf",
            "percentage closer filtering of a depth map",
            "Reeves, Salesin, Cook 1987",
            1,
            {.opaque_only = true},
            parameters,
            [](const ParameterValues& values) -> std::unique_ptr<Map> {
                return std::make_unique<PercentageCloser>(values);
            },
            [](const ParameterValues&, const rays::MapLayout&) { return 0.0; },
            nullptr,
            [](const ParameterValues& values, const rays::MapLayout& layout) {
                return make_cells(layout, read_cells(values)).count() * sizeof(float);
            }};
}

}  // namespace shadowbench::techniques
