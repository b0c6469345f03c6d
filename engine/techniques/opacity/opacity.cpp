// Opacity shadow maps: Kim and Neumann, Opacity Shadow Maps, 2001, as Salvi et al. 2010 compare them.
#include <array>

#include "techniques/store/slices.h"
#include "techniques/store/texel_map.h"

namespace shadowbench::techniques {
namespace {

constexpr int most_slices = 256;

const Parameter parameters[] = {
    {"slices", ParameterKind::integer, "depths at which a texel holds the optical depth so far", 32, 1, most_slices},
    {.name = "bounds",
     .kind = ParameterKind::choice,
     .doc = "the depths between which the slices lie: those of all shadow casters in the map, or those of each texel",
     .standard_word = "map",
     .words = {"map", "texel"}},
    {"opaque_depth", ParameterKind::number,
     "largest optical depth of one segment, also used for opaque surfaces; ln 256 makes them black in 8 bits", 5.545, 1,
     80},
    filter_parameter,
    averaged_cells_parameter,
};

// A texel is the optical depth from the light to each slice. Slice i is at the end of interval i; before the first
// interval the optical depth is 0. Texels with bounds of their own hold two more floats after the slices: the depth
// where the intervals begin, and the number of intervals per unit of depth.
// Between slices the optical depth is linear, as published, and so the extinction constant.
class Opacity final : public TexelMap<Opacity> {
public:
    explicit Opacity(const ParameterValues& values)
        : TexelMap(values),
          count_(values.integer("slices")),
          own_bounds_(has_own_bounds(values)),
          opaque_depth_(values.number("opaque_depth")) {}
    static int floats_a_texel(const ParameterValues& values) {
        return values.integer("slices") + (has_own_bounds(values) ? 2 : 0);
    }

    void begin(const BuildInput& input) override {
        TexelMap::begin(input);
        slices_ = Slices(layout_.z_min, layout_.z_max, count_);
    }

    void fill(const rays::LightRays& rays) {
        std::array<double, most_slices> parts;
        for_each_texel(rays, [&](float* texel, std::size_t, std::size_t ray) {
            std::fill_n(parts.begin(), count_, 0.0);
            const Slices slices = own_bounds_ ? bounds_of(rays, ray) : slices_;
            slices.spread_ray(rays, ray, opaque_depth_, [&](int i, double part) { parts[i] += part; });
            double sum = 0.0;
            for (int i = 0; i < count_; ++i) texel[i] = static_cast<float>(sum += parts[i]);
            if (!own_bounds_) return;
            texel[count_] = slices.near;
            texel[count_ + 1] = slices.scale;
        });
    }

    // If all texels have the same slices, the position among them is the same for all texels of a lookup.
    float prepare(float z) const { return own_bounds_ ? z : slices_.place(z); }
    float evaluate(const float* texel, float prepared) const {
        return evaluate_at(texel, own_bounds_ ? slices_of(texel).place(prepared) : prepared);
    }

    void touched(const Query& q, std::vector<const void*>& lines) const override {
        const std::size_t before = lines.size();
        texels_.for_each(q, [&](std::size_t cell, double) {
            const float* texel = texels_.at(cell);
            const Slices slices = slices_of(texel);
            const int i = slices.interval(slices.place(q.z));
            touch_lines(texel + std::max(i - 1, 0), (i > 0 ? 2 : 1) * sizeof(float), lines);
            if (own_bounds_) touch_lines(texel + count_, 2 * sizeof(float), lines);
        });
        keep_unique(lines, before);
    }

    int nodes_of(const float* texel) const { return texel[count_ - 1] == 0.0f ? 0 : count_; }
    static constexpr int most_own_depths = most_slices + 1;
    int own_depths(const float* texel, float* out) const {
        const Slices slices = slices_of(texel);
        for (int i = 0; i < count_; ++i) out[i] = slices.depth(i);
        out[count_] = slices.behind();
        return count_ + 1;
    }

private:
    static bool has_own_bounds(const ParameterValues& values) { return values.word("bounds") == "texel"; }

    Slices slices_of(const float* texel) const {
        if (!own_bounds_) return slices_;
        Slices slices;
        slices.near = texel[count_];
        slices.scale = texel[count_ + 1];
        slices.count = count_;
        return slices;
    }

    // From the first depth of a ray to just behind its last, so that segments at the last depth are before only the
    // last slice.
    Slices bounds_of(const rays::LightRays& rays, std::size_t ray) const {
        float low = layout_.z_max, high = layout_.z_min;
        for (std::uint32_t s = rays.begin[ray]; s < rays.begin[ray + 1]; ++s) {
            if (rays.transmittance[s] >= 1.0f) continue;
            low = std::min(low, rays.z_front[s]);
            high = std::max(high, rays.back(s));
        }
        if (low > high) return slices_;
        return {low, std::nextafter(high, std::numeric_limits<float>::infinity()), count_};
    }

    float evaluate_at(const float* texel, float place) const {
        const int i = std::min(static_cast<int>(place), count_ - 1);
        const float before = i > 0 ? texel[i - 1] : 0.0f, behind = texel[i];
        const float depth = before + (place - static_cast<float>(i)) * (behind - before);
        return std::exp(-std::min(depth, behind));
    }

    int count_;
    bool own_bounds_;
    double opaque_depth_;
    Slices slices_;
};

Promises promised(const ParameterValues& values) {
    return {.localised = false, .leak = std::exp(-values.number("opaque_depth"))};
}

}  // namespace

// Not traded: `opaque_depth`, which costs nothing; `cells`, for the reason of avsm.
Technique opacity() {
    Traits traits = texel_traits();
    traits.trades = {{"slices", Trade::Scale::logarithmic, 1, most_slices},
                     {.parameter = "bounds", .choices = {"map", "texel"}},
                     filter_trade};
    return {.id = "opacity",
            .title = "opacity shadow map: optical depth at uniform slices",
            .paper = "Kim, Neumann 2001",
            .version = 3,
            .promises = {.localised = false, .leak = std::exp(-5.545)},
            .parameters = parameters,
            .create = create_map<Opacity>,
            .least_bytes = Opacity::least_bytes,
            .promises_of = promised,
            .traits = traits};
}

}  // namespace shadowbench::techniques
