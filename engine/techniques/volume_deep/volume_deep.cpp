// Deep shadow maps from volumetric data: the depths at which a ray has lost 10, 50 and 90 % of its light, and its total
// loss.
#include <cstring>

#include "techniques/store/slices.h"
#include "techniques/store/texel_map.h"
#include "techniques/volume_deep/crossings.h"

namespace shadowbench::techniques {
namespace {

constexpr int most_steps = 512;
// The optical depth of an opaque surface: behind it, nothing is left of a float's 1.
constexpr double opaque_depth = 80.0;

const Parameter parameters[] = {
    {"steps", ParameterKind::integer, "marching steps from the first to the last depth of the map", most_steps, 1,
     most_steps},
    {.name = "interpolation",
     .kind = ParameterKind::choice,
     .doc = "where the depth of a threshold lies: inside the step that crosses it, by smooth step, or at the end of "
            "the last step before",
     .standard_word = "smooth",
     .words = {"smooth", "bucket"}},
    filter_parameter,
    averaged_cells_parameter,
};

constexpr int texel_floats = 4;
static_assert(sizeof(Crossings) == texel_floats * sizeof(float));

// The technique marches on its own: regular steps from the map's first to its last depth, whatever the steps of the
// light rays are. A step loses the light that the ray's segments absorb in it, so that it includes thin segments too.
class VolumeDeep final : public TexelMap<VolumeDeep> {
public:
    explicit VolumeDeep(const ParameterValues& values)
        : TexelMap(values),
          count_(values.integer("steps")),
          placed_(values.word("interpolation") == "smooth" ? Crossing::smooth : Crossing::bucket) {}

    static int floats_a_texel(const ParameterValues&) { return texel_floats; }

    void begin(const BuildInput& input) override {
        TexelMap::begin(input);
        steps_ = Slices(layout_.z_min, layout_.z_max, count_);
    }

    void fill(const rays::LightRays& rays) {
        std::array<double, most_steps> parts{};
        for_each_texel(rays, [&](float* texel, std::size_t, std::size_t ray) {
            const int last = steps_.spread_ray(rays, ray, opaque_depth, [&](int i, double part) { parts[i] += part; });
            const std::span<double> used(parts.data(), last + 1);
            double depth = 0.0, opacity = 0.0;
            for (double& part : used) {
                if (part > 0.0) opacity = -std::expm1(-(depth += part));
                part = opacity;
            }
            const auto end = [&](int i) { return i < count_ ? steps_.depth(i) : layout_.z_max; };
            const Crossings crossings = make_crossings(used, end, placed_);
            std::memcpy(texel, &crossings, sizeof crossings);
            std::fill(used.begin(), used.end(), 0.0);
        });
    }

    float prepare(float z) const { return z; }
    float evaluate(const float* texel, float z) const { return visibility(read(texel), z); }
    int nodes_of(const float* texel) const { return read(texel).most > 0.0f ? texel_floats : 0; }

    // The function may jump at each depth of the texel.
    void stored(int x, int y, int, std::span<const float> depths, curves::Curve& out) const override {
        out.clear();
        const Crossings c = read(texels_.at(texels_.grid.index(x, y)));
        if (c.most == 0.0f) return;
        std::size_t k = 0;
        for (std::size_t i = 0; i < c.depth.size(); ++i) {
            const float z = c.depth[i];
            if (i > 0 && z == c.depth[i - 1])
                out.pop_back();  // only the last of several crossings at one depth counts
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

    int count_;
    Crossing placed_;
    Slices steps_;
};

}  // namespace

// Not traded: `interpolation=bucket`, which is less accurate at the same cost; `cells`, for the reason of avsm.
Technique volume_deep() {
    Traits traits = texel_traits();
    traits.trades = {{"steps", Trade::Scale::logarithmic, 8, most_steps}, filter_trade};
    return {.id = "volume_deep",
            .title = "deep shadow map of volumes: depths at 10, 50 and 90 % opacity, and the maximum opacity",
            .paper = "Deep Shadow Maps from Volumetric Data",
            .version = 3,
            .promises = {.localised = false},
            .parameters = parameters,
            .create = create_map<VolumeDeep>,
            .least_bytes = VolumeDeep::least_bytes,
            .traits = traits};
}

}  // namespace shadowbench::techniques
