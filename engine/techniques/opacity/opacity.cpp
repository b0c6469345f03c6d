#include "techniques/opacity/opacity.h"

#include <array>

#include "techniques/slices.h"
#include "techniques/texels.h"

namespace shadowbench::techniques {
namespace {

constexpr int most_slices = 256;

const Parameter parameters[] = {
    {"slices", ParameterKind::integer, "depths at which a texel holds the optical depth so far", 32, 1, most_slices},
    {"bounds",
     ParameterKind::choice,
     "between which depths the slices stand: those of all that casts shadows in the map, or of each texel alone",
     0,
     0,
     0,
     "map",
     {"map", "texel"}},
    {"opaque_depth", ParameterKind::number,
     "largest optical depth of one segment, and that of something opaque; ln 256 makes it black in 8 bits", 5.545, 1,
     80},
    filter_parameter,
    cells_parameter,
};

// A texel is the optical depth from the light to each slice; slice i stands at the end of interval i, and before the
// first interval there is nothing. Texels with bounds of their own hold two floats more, behind the slices: where the
// intervals begin, and how many there are in a unit of depth.
// Between slices the optical depth is linear, as published, and so the extinction constant.
class Opacity final : public Map {
public:
    explicit Opacity(const ParameterValues& values)
        : texels_(values),
          count_(values.integer("slices")),
          own_bounds_(values.word("bounds") == "texel"),
          opaque_depth_(values.number("opaque_depth")) {}

    void begin(const BuildInput& input) override {
        layout_ = input.layout;
        slices_ = Slices(layout_.z_min, layout_.z_max, count_);
        texels_.allocate(layout_, floats_a_texel(count_, own_bounds_));
    }

    void add(const rays::LightRays& rays) override {
        std::array<double, most_slices> parts;
        for_each_cell(layout_, texels_.grid, texels_.kind, rays, [&](std::size_t cell, std::size_t ray) {
            float* texel = texels_.at(cell);
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
    void finish() override {}

    void lookup(std::span<const Query> queries, std::span<float> visibility) const override {
        if (own_bounds_)
            texels_.lookup(
                queries, visibility, [](float z) { return z; },
                [&](const float* texel, float z) { return evaluate(texel, slices_of(texel).place(z)); });
        else
            texels_.lookup(
                queries, visibility, [&](float z) { return slices_.place(z); },
                [&](const float* texel, float place) { return evaluate(texel, place); });
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

    std::size_t bytes() const override { return texels_.bytes(); }
    std::size_t working_bytes() const override { return bytes(); }
    NodeStats nodes() const override {
        NodeStats stats;
        for (std::size_t cell = 0; cell < texels_.grid.count(); ++cell) stats.add(is_empty(cell) ? 0 : count_);
        return stats;
    }
    Cells cells() const override { return texels_.kind; }
    void stored(int x, int y, int, std::span<const float> depths, curves::Curve& out) const override {
        out.clear();
        const std::size_t cell = texels_.grid.index(x, y);
        if (is_empty(cell)) return;
        const float* texel = texels_.at(cell);
        const Slices slices = slices_of(texel);
        std::array<float, most_slices + 1> own;
        for (int i = 0; i < count_; ++i) own[i] = slices.depth(i);
        own[count_] = slices.behind();
        sample_function(
            {own.data(), own.data() + count_ + 1}, depths, [&](float z) { return evaluate(texel, slices.place(z)); },
            out);
    }

    static int floats_a_texel(int slices, bool own_bounds) { return slices + (own_bounds ? 2 : 0); }

private:
    Slices slices_of(const float* texel) const {
        if (!own_bounds_) return slices_;
        Slices slices;
        slices.near = texel[count_];
        slices.scale = texel[count_ + 1];
        slices.count = count_;
        return slices;
    }

    // From the first depth of a ray to just behind its last: what stands there is behind no slice but the last.
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

    float evaluate(const float* texel, float place) const {
        const int i = std::min(static_cast<int>(place), count_ - 1);
        const float before = i > 0 ? texel[i - 1] : 0.0f, behind = texel[i];
        const float depth = before + (place - static_cast<float>(i)) * (behind - before);
        return std::exp(-std::min(depth, behind));
    }

    bool is_empty(std::size_t cell) const { return texels_.at(cell)[count_ - 1] == 0.0f; }

    Texels texels_;
    int count_;
    bool own_bounds_;
    double opaque_depth_;
    rays::MapLayout layout_;
    Slices slices_;
};

Promises promised(const ParameterValues& values) {
    return {.localised = false, .leak = std::exp(-values.number("opaque_depth"))};
}

}  // namespace

Technique opacity() {
    return {"opacity",
            "opacity shadow map: optical depth at uniform slices",
            "Kim, Neumann 2001",
            3,
            {.localised = false, .leak = std::exp(-5.545)},
            parameters,
            [](const ParameterValues& values) -> std::unique_ptr<Map> { return std::make_unique<Opacity>(values); },
            [](const ParameterValues&, const rays::MapLayout&) { return std::numeric_limits<double>::infinity(); },
            nullptr,
            [](const ParameterValues& values, const rays::MapLayout& layout) {
                return Texels::bytes(
                    values, layout,
                    Opacity::floats_a_texel(values.integer("slices"), values.word("bounds") == "texel"));
            },
            false,
            promised};
}

}  // namespace shadowbench::techniques
