#include "techniques/fourier/fourier.h"

#include "techniques/fourier/series.h"
#include "techniques/slices.h"
#include "techniques/texels.h"

namespace shadowbench::techniques {
namespace {

const Parameter parameters[] = {
    {"terms", ParameterKind::integer,
     "terms of the series, each a cosine and a sine coefficient; the first one is the mean", 16, 1, most_terms},
    {"range",
     ParameterKind::choice,
     "where ringing makes the series rise above 1: clamped to 1, or raw",
     0,
     0,
     0,
     "clamped",
     {"clamped", "raw"}},
    {"opaque_depth", ParameterKind::number,
     "largest absorption of one segment, and that of something opaque; ln 256 makes it black in 8 bits", 5.545, 1, 80},
    filter_parameter,
    cells_parameter,
};

constexpr float highest_raw = 1e30f;  // raw answers stay finite

// A texel is padded(terms) floats, see series.h. At 16 terms these are the 128 bytes that Salvi et al. 2010, table 1,
// count for "16 terms". Depth is normalised between the bounds of the whole map. Lookups filter transmittance, as those
// of all techniques here do; the series itself, which could be filtered too, is not.
class Fourier final : public Map {
public:
    explicit Fourier(const ParameterValues& values)
        : texels_(values), terms_(values.integer("terms")), opaque_depth_(values.number("opaque_depth")) {
        highest_ = values.word("range") == "raw" ? highest_raw : 1.0f;
        texels_.highest = highest_;
    }

    void begin(const BuildInput& input) override {
        layout_ = input.layout;
        texels_.allocate(layout_, padded(terms_));
    }

    void add(const rays::LightRays& rays) override {
        Series series;
        for_each_cell(layout_, texels_.grid, texels_.kind, rays, [&](std::size_t cell, std::size_t ray) {
            if (rays.begin[ray] == rays.begin[ray + 1]) {
                std::fill_n(texels_.at(cell), texels_.stride, 0.0f);
                return;
            }
            series.clear();
            for (std::uint32_t s = rays.begin[ray]; s < rays.begin[ray + 1]; ++s)
                if (rays.transmittance[s] < 1.0f)
                    series.add(normalised(rays.z_front[s]), normalised(rays.back(s)),
                               optical_depth(rays.transmittance[s], opaque_depth_), terms_);
            series.store(terms_, texels_.at(cell));
        });
    }
    void finish() override {}

    void lookup(std::span<const Query> queries, std::span<float> visibility) const override {
        texels_.lookup(
            queries, visibility, [&](float z) { return weights_at(z); },
            [&](const float* texel, const Weights& weights) { return evaluate(texel, weights); });
    }

    void touched(const Query& q, std::vector<const void*>& lines) const override {
        const std::size_t before = lines.size();
        texels_.for_each(
            q, [&](std::size_t cell, double) { touch_lines(texels_.at(cell), sizeof(float) * texels_.stride, lines); });
        keep_unique(lines, before);
    }

    std::size_t bytes() const override { return texels_.bytes(); }
    std::size_t working_bytes() const override { return bytes(); }
    NodeStats nodes() const override {
        NodeStats stats;
        for (std::size_t cell = 0; cell < texels_.grid.count(); ++cell) stats.add(is_empty(cell) ? 0 : terms_);
        return stats;
    }
    Cells cells() const override { return texels_.kind; }

    // Its own depths: eight in the shortest wave.
    void stored(int x, int y, int, std::span<const float> depths, curves::Curve& out) const override {
        out.clear();
        const std::size_t cell = texels_.grid.index(x, y);
        if (is_empty(cell)) return;
        std::array<float, 8 * most_terms + 1> own;
        const int count = 8 * terms_;
        for (int i = 0; i <= count; ++i)
            own[i] =
                static_cast<float>(layout_.z_min + (static_cast<double>(layout_.z_max) - layout_.z_min) * i / count);
        own[count] = std::max(own[count], std::nextafter(layout_.z_min, std::numeric_limits<float>::infinity()));
        sample_function(
            {own.data(), own.data() + count + 1}, depths,
            [&](float z) { return evaluate(texels_.at(cell), weights_at(z)); }, out);
    }

private:
    // 0 at the map's first depth and before, 1 at its last and behind.
    double normalised(float z) const {
        if (!(z > layout_.z_min)) return 0.0;
        if (z >= layout_.z_max) return 1.0;
        return (static_cast<double>(z) - layout_.z_min) / (static_cast<double>(layout_.z_max) - layout_.z_min);
    }
    Weights weights_at(float z) const {
        Weights weights;
        make_weights(normalised(z), terms_, weights);
        return weights;
    }
    float evaluate(const float* texel, const Weights& weights) const {
        return std::min(std::exp(-integral(texel, weights, texels_.stride)), highest_);
    }
    // a_0 is twice all absorption.
    bool is_empty(std::size_t cell) const { return texels_.at(cell)[0] == 0.0f; }

    Texels texels_;
    int terms_;
    double opaque_depth_;
    float highest_;
    rays::MapLayout layout_;
};

Promises promised(const ParameterValues& values) {
    return {.monotone = false,
            .unit_range = values.word("range") == "clamped",
            .localised = false,
            .leak = std::exp(-values.number("opaque_depth"))};
}

}  // namespace

Technique fourier() {
    return {"fourier",
            "Fourier opacity map: a truncated series of the absorption",
            "Jansen, Bavoil 2010",
            3,
            {.monotone = false, .localised = false, .leak = std::exp(-5.545)},
            parameters,
            [](const ParameterValues& values) -> std::unique_ptr<Map> { return std::make_unique<Fourier>(values); },
            [](const ParameterValues&, const rays::MapLayout&) { return std::numeric_limits<double>::infinity(); },
            nullptr,
            [](const ParameterValues& values, const rays::MapLayout& layout) {
                return Texels::bytes(values, layout, padded(values.integer("terms")));
            },
            false,
            promised};
}

}  // namespace shadowbench::techniques
