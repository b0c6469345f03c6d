// Fourier opacity maps: Jansen and Bavoil, Fourier Opacity Mapping, 2010.
#include "techniques/fourier/series.h"
#include "techniques/store/slices.h"
#include "techniques/store/texel_map.h"

namespace shadowbench::techniques {
namespace {

const Parameter parameters[] = {
    {"terms", ParameterKind::integer,
     "terms of the series, each a cosine and a sine coefficient; the first one is the mean", 16, 1, most_terms},
    {.name = "range",
     .kind = ParameterKind::choice,
     .doc = "where ringing lifts the series above 1: clamped to 1, or left as it is (raw)",
     .standard_word = "clamped",
     .words = {"clamped", "raw"}},
    {"opaque_depth", ParameterKind::number,
     "largest absorption of one segment, also used for opaque surfaces; ln 256 makes them black in 8 bits", 5.545, 1,
     80},
    filter_parameter,
    averaged_cells_parameter,
};

constexpr float highest_raw = 1e30f;  // raw answers stay finite

// A texel is padded(terms) floats, see series.h. At 16 terms these are the 128 bytes that Salvi et al. 2010, table 1,
// count for "16 terms". Depth is normalised between the bounds of the whole map. Lookups filter transmittance, as in
// all techniques here; the series, which could also be filtered, is not.
class Fourier final : public TexelMap<Fourier> {
public:
    explicit Fourier(const ParameterValues& values)
        : TexelMap(values), terms_(values.integer("terms")), opaque_depth_(values.number("opaque_depth")) {
        highest_ = values.word("range") == "raw" ? highest_raw : 1.0f;
        texels_.highest = highest_;
    }
    static int floats_a_texel(const ParameterValues& values) { return padded(values.integer("terms")); }

    void fill(const rays::LightRays& rays) {
        Series series;
        for_each_texel(rays, [&](float* texel, std::size_t, std::size_t ray) {
            if (rays.begin[ray] == rays.begin[ray + 1]) {
                std::fill_n(texel, texels_.stride, 0.0f);
                return;
            }
            series.clear();
            for (std::uint32_t s = rays.begin[ray]; s < rays.begin[ray + 1]; ++s)
                if (rays.transmittance[s] < 1.0f)
                    series.add(normalised(rays.z_front[s]), normalised(rays.back(s)),
                               optical_depth(rays.transmittance[s], opaque_depth_), terms_);
            series.store(terms_, texel);
        });
    }

    Weights prepare(float z) const {
        Weights weights;
        make_weights(normalised(z), terms_, weights);
        return weights;
    }
    void prepare_all(std::span<const Query> block, std::array<Weights, block_queries>& weights) const {
        for (std::size_t k = 0; k < block.size(); ++k) make_weights(normalised(block[k].z), terms_, weights[k]);
    }
    float evaluate(const float* texel, const Weights& weights) const {
        return transmittance(texel, weights, texels_.stride, highest_);
    }
    void evaluate_all(Reads& reads, const std::array<Weights, block_queries>& weights) const {
        transmittances(reads, weights, texels_.stride, highest_);
    }
    int nodes_of(const float* texel) const { return texel[0] == 0.0f ? 0 : terms_; }  // a_0 is twice all absorption

    // Eight in the shortest wave.
    static constexpr int most_own_depths = 8 * most_terms + 1;
    int own_depths(const float*, float* out) const {
        const int count = 8 * terms_;
        for (int i = 0; i <= count; ++i)
            out[i] =
                static_cast<float>(layout_.z_min + (static_cast<double>(layout_.z_max) - layout_.z_min) * i / count);
        out[count] = std::max(out[count], std::nextafter(layout_.z_min, std::numeric_limits<float>::infinity()));
        return count + 1;
    }

private:
    // 0 at the map's first depth and before, 1 at its last and behind.
    double normalised(float z) const {
        if (!(z > layout_.z_min)) return 0.0;
        if (z >= layout_.z_max) return 1.0;
        return (static_cast<double>(z) - layout_.z_min) / (static_cast<double>(layout_.z_max) - layout_.z_min);
    }
    int terms_;
    double opaque_depth_;
    float highest_;
};

Promises promised(const ParameterValues& values) {
    return {.monotone = false,
            .unit_range = values.word("range") == "clamped",
            .localised = false,
            .leak = std::exp(-values.number("opaque_depth"))};
}

}  // namespace

// Not traded: `range=raw`, whose answers above 1 are only less accurate; `opaque_depth` and `cells`, as for opacity.
Technique fourier() {
    Traits traits = texel_traits();
    traits.trades = {{"terms", Trade::Scale::logarithmic, 1, most_terms}, filter_trade};
    return {.id = "fourier",
            .title = "Fourier opacity map: a truncated series of the absorption",
            .paper = "Jansen, Bavoil 2010",
            .version = 4,
            .promises = {.monotone = false, .localised = false, .leak = std::exp(-5.545)},
            .parameters = parameters,
            .create = create_map<Fourier>,
            .least_bytes = Fourier::least_bytes,
            .promises_of = promised,
            .traits = traits};
}

}  // namespace shadowbench::techniques
