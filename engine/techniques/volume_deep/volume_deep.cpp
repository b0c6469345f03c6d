#include "techniques/volume_deep/volume_deep.h"

#include <cstring>

#include "techniques/slices.h"
#include "techniques/texels.h"
#include "techniques/volume_deep/crossings.h"

namespace shadowbench::techniques {
namespace {

constexpr int most_steps = 512;
// What something opaque absorbs: nothing is left of a float's 1 behind it.
constexpr double opaque_depth = 80.0;

const Parameter parameters[] = {
    {"steps", ParameterKind::integer, "marching steps from the first to the last depth of the map", most_steps, 1,
     most_steps},
    {"interpolation",
     ParameterKind::choice,
     "where a threshold is crossed: inside its step by smooth step, or at the end of the last step before",
     0,
     0,
     0,
     "smooth",
     {"smooth", "bucket"}},
    filter_parameter,
    cells_parameter,
};

constexpr int floats_a_texel = 4;
static_assert(sizeof(Crossings) == floats_a_texel * sizeof(float));

// The technique marches on its own: regular steps from the map's first to its last depth, whatever the steps of the
// light rays are. The light lost in a step is what the ray's segments take in it, so that a step sees thin things too.
class VolumeDeep final : public Map {
public:
    explicit VolumeDeep(const ParameterValues& values)
        : texels_(values),
          count_(values.integer("steps")),
          placed_(values.word("interpolation") == "smooth" ? Crossing::smooth : Crossing::bucket) {}

    void begin(const BuildInput& input) override {
        layout_ = input.layout;
        steps_ = Slices(layout_.z_min, layout_.z_max, count_);
        texels_.allocate(layout_, floats_a_texel);
    }

    void add(const rays::LightRays& rays) override {
        std::array<double, most_steps> parts{};
        for_each_cell(layout_, texels_.grid, texels_.kind, rays, [&](std::size_t cell, std::size_t ray) {
            const int last = steps_.spread_ray(rays, ray, opaque_depth, [&](int i, double part) { parts[i] += part; });
            const std::span<double> used(parts.data(), last + 1);
            double depth = 0.0, opacity = 0.0;
            for (double& part : used) {
                if (part > 0.0) opacity = -std::expm1(-(depth += part));
                part = opacity;
            }
            const auto end = [&](int i) { return i < count_ ? steps_.depth(i) : layout_.z_max; };
            const Crossings texel = make_crossings(used, end, placed_);
            std::memcpy(texels_.at(cell), &texel, sizeof texel);
            std::fill(used.begin(), used.end(), 0.0);
        });
    }
    void finish() override {}

    void lookup(std::span<const Query> queries, std::span<float> visibilities) const override {
        texels_.lookup(
            queries, visibilities, [](float z) { return z; },
            [](const float* texel, float z) { return visibility(read(texel), z); });
    }

    void touched(const Query& q, std::vector<const void*>& lines) const override {
        const std::size_t before = lines.size();
        texels_.for_each(q, [&](std::size_t cell, double) { touch_lines(texels_.at(cell), sizeof(Crossings), lines); });
        keep_unique(lines, before);
    }

    std::size_t bytes() const override { return texels_.bytes(); }
    std::size_t working_bytes() const override { return bytes(); }
    NodeStats nodes() const override {
        NodeStats stats;
        for (std::size_t cell = 0; cell < texels_.grid.count(); ++cell)
            stats.add(read(texels_.at(cell)).most > 0.0f ? floats_a_texel : 0);
        return stats;
    }
    Cells cells() const override { return texels_.kind; }

    // At each depth of the texel the function may jump.
    void stored(int x, int y, int, std::span<const float> depths, curves::Curve& out) const override {
        out.clear();
        const Crossings c = read(texels_.at(texels_.grid.index(x, y)));
        if (c.most == 0.0f) return;
        std::size_t k = 0;
        for (std::size_t i = 0; i < c.depth.size(); ++i) {
            const float z = c.depth[i];
            if (i > 0 && z == c.depth[i - 1])
                out.pop_back();  // what lies behind several crossings belongs to the last
            else {
                for (; k < depths.size() && depths[k] < z; ++k) out.push_back({depths[k], visibility(c, depths[k])});
                out.push_back({z, visibility(c, z)});
            }
            out.push_back({z, visibility_behind(c, i)});
            while (k < depths.size() && depths[k] <= z) ++k;
        }
        for (; k < depths.size(); ++k) out.push_back({depths[k], visibility(c, depths[k])});
    }

private:
    static Crossings read(const float* texel) {
        Crossings result;
        std::memcpy(&result, texel, sizeof result);
        return result;
    }

    Texels texels_;
    int count_;
    Crossing placed_;
    rays::MapLayout layout_;
    Slices steps_;
};

}  // namespace

Technique volume_deep() {
    return {"volume_deep",
            "deep shadow map of volumes: depths at 10, 50 and 90 % opacity, and the maximum opacity",
            "Deep Shadow Maps from Volumetric Data",
            3,
            {.localised = false},
            parameters,
            [](const ParameterValues& values) -> std::unique_ptr<Map> { return std::make_unique<VolumeDeep>(values); },
            [](const ParameterValues&, const rays::MapLayout&) { return std::numeric_limits<double>::infinity(); },
            nullptr,
            [](const ParameterValues& values, const rays::MapLayout& layout) {
                return Texels::bytes(values, layout, floats_a_texel);
            }};
}

}  // namespace shadowbench::techniques
