#include "techniques/deep/deep.h"

#include <cmath>

#include "techniques/deep/deep_map.h"
#include "techniques/deep/mip.h"

namespace shadowbench::techniques {
namespace {

const Parameter parameters[] = {
    {"tolerance",
     ParameterKind::number_or_word,
     "largest error of a stored function; \"noise\" is 0.25 / sqrt(samples a pixel), half of the rays' worst expected "
     "noise",
     0,
     0,
     1,
     "noise",
     {"noise"}},
    {"compression",
     ParameterKind::choice,
     "bounded: never rises, stays in [0, 1], ends on the exact value where one segment can; published: the paper's "
     "text "
     "word for word, which keeps the tolerance too, but rises by up to it and falls below 0 by up to it",
     0,
     0,
     0,
     "bounded",
     {"bounded", "published"}},
    {"filter",
     ParameterKind::choice,
     "how the rays around a pixel's centre make its function; a gaussian falls to exp(-2) at its radius",
     0,
     0,
     0,
     "box",
     {"box", "tent", "gaussian"}},
    {"radius", ParameterKind::number, "radius of the filter in pixels; a box of 0.5 is exactly the pixel", 0.5, 0.5, 8},
    {"mip",
     ParameterKind::choice,
     "coarser levels for wide lookups, each within half the tolerance of the one before, so within twice the tolerance "
     "in all: none, the nearest level, or a blend of two",
     0,
     0,
     0,
     "none",
     {"none", "nearest", "blend"}},
    {"kernel",
     ParameterKind::choice,
     "how a lookup weights pixels: box, by the part of each that its footprint covers, which at one pixel's width is "
     "bilinear interpolation, the lookup of renderers; tent, twice as wide; pixels, the paper's box: whole pixels whose "
     "centres lie within the filter radius",
     0,
     0,
     0,
     "box",
     {"box", "tent", "pixels"}},
    {"search",
     ParameterKind::choice,
     "how a lookup finds the segment of a function: cached starts at the segment that the same batch used last in that "
     "pixel; all give the same answers",
     0,
     0,
     0,
     "binary",
     {"binary", "linear", "cached"}},
};

double tolerance_of(const ParameterValues& values, int samples) {
    return values.is_word("tolerance") ? 0.25 / std::sqrt(static_cast<double>(samples)) : values.number("tolerance");
}

bool is_published(const ParameterValues& values) {
    return values.word("compression") == "published";
}

PixelFilter filter_of(const ParameterValues& values) {
    const std::string& shape = values.word("filter");
    return {shape == "box"    ? FilterShape::box
            : shape == "tent" ? FilterShape::tent
                              : FilterShape::gaussian,
            values.number("radius")};
}

LookupRule rule_of(const ParameterValues& values) {
    const std::string &kernel = values.word("kernel"), &mip = values.word("mip"), &search = values.word("search");
    return {kernel == "box"    ? Kernel::box
            : kernel == "tent" ? Kernel::tent
                               : Kernel::pixels,
            mip == "none"      ? Mip::none
            : mip == "nearest" ? Mip::nearest
                               : Mip::blend,
            search == "binary"   ? Search::binary
            : search == "linear" ? Search::linear
                                 : Search::cached};
}

class Deep final : public Map {
public:
    explicit Deep(const ParameterValues& values) : values_(values) {
        map_.compression.published = is_published(values);
        map_.filter = filter_of(values);
        map_.rule = rule_of(values);
    }

    // A map of given functions, one pixel high. It has no rays to filter.
    Deep(const ParameterValues& values, std::span<const curves::Curve> functions) : Deep(values) {
        map_.compression.tolerance = static_cast<float>(tolerance_of(values, 1));
        map_.filter = {};
        map_.make(functions);
    }

    RayNeeds needs() const override { return {map_.filter.apron(), false}; }
    void begin(const BuildInput& input) override {
        map_.compression.tolerance = static_cast<float>(tolerance_of(values_, input.layout.samples()));
        map_.begin(input.layout);
        channels_ = input.layout.channels;
    }
    void add(const rays::LightRays& tile) override { map_.add(tile); }
    void finish() override { map_.finish(); }
    void set_lookups(const ParameterValues& values) override { map_.rule = rule_of(values); }

    int channels() const override { return channels_; }
    void lookup(std::span<const Query> queries, std::span<float> visibility) const override {
        techniques::lookup(map_.levels, map_.rule, queries, visibility);
    }
    void touched(const Query& query, std::vector<const void*>& lines) const override {
        techniques::touched(map_.levels, map_.rule, query, lines);
    }
    std::size_t bytes() const override { return map_.bytes(); }
    std::size_t working_bytes() const override { return map_.peak_bytes; }
    NodeStats nodes() const override { return map_.stats(); }

    Cells cells() const override { return map_.filter.is_pixel() ? Cells::pixel : Cells::filtered; }
    void stored(int x, int y, int channel, std::span<const float>, curves::Curve& out) const override {
        read_function(map_.levels[0], map_.levels[0].pixel(x, y), channel, out);
    }
    void weights(int x, int y, const rays::LightRays& tile, std::vector<curves::WeightedRay>& out) const override {
        map_.weights(x, y, tile, out);
    }

    std::span<const DeepLevel> levels() const { return map_.levels; }

private:
    ParameterValues values_;
    DeepMap map_;
    int channels_ = 1;
};

// The offsets, colour flags and padding that every level has.
std::size_t least_bytes(const ParameterValues& values, const rays::MapLayout& layout) {
    const int levels = values.word("mip") == "none" ? 1 : mip_levels(layout.width, layout.height);
    std::size_t sum = 0;
    for (int l = 0; l < levels; ++l) {
        const std::size_t pixels = static_cast<std::size_t>(mip_size(layout.width, l)) * mip_size(layout.height, l);
        sum += (pixels + 1) * sizeof(std::uint32_t) + DeepLevel::padding * sizeof(float);
        if (layout.channels == 3) sum += (pixels + 63) / 64 * sizeof(std::uint64_t);
    }
    return sum;
}

// Not traded: `compression=published`, which keeps the same tolerance with other faults; `filter` and `radius`, which
// widen every lookup beyond its footprint; `kernel=pixels`, which drops and adds whole pixels; `search`, whose cached
// and linear ways gain only where neighbours are looked up together, or for very short functions.
std::vector<Trade> deep_trades() {
    return {{"tolerance", Trade::Scale::logarithmic, 0.2, 0.0005},
            {.parameter = "kernel", .choices = {"box", "tent"}, .only_lookups = true},
            {.parameter = "mip", .choices = {"none", "nearest", "blend"}}};
}

}  // namespace

std::span<const DeepLevel> levels(const Map& map) {
    const auto* deep = dynamic_cast<const Deep*>(&map);
    return deep ? deep->levels() : std::span<const DeepLevel>();
}

Technique deep() {
    return {.id = "deep",
            .title = "deep shadow map: visibility functions compressed within a tolerance",
            .paper = "Lokovic, Veach 2000",
            .version = 4,
            .parameters = parameters,
            .create = create_map<Deep>,
            .error_bound =
                [](const ParameterValues& values, const rays::MapLayout& layout) {
                    const double tolerance = tolerance_of(values, layout.samples());
                    return layout.media ? std::max(tolerance, linearisation_of(tolerance)) : tolerance;
                },
            .from_curves = [](const ParameterValues& values, std::span<const curves::Curve> functions)
                -> std::unique_ptr<Map> { return std::make_unique<Deep>(values, functions); },
            .least_bytes = least_bytes,
            .coloured = true,
            .promises_of = [](const ParameterValues& values) -> Promises {
                const bool bounded = !is_published(values);
                return {.monotone = bounded, .unit_range = bounded};
            },
            // Values that are twice the tolerance apart are joined or not depending on their rounding, and so on the
            // order of their sums: no two products of round numbers are twice this apart.
            .traits = {.pointwise = {{"mip", "none"}, {"kernel", "box"}},
                       .order_free = {{"tolerance", 0.0131}},
                       .whole_pixel = {{"filter", "box"}, {"radius", 0.5}},
                       .trades = deep_trades()}};
}

}  // namespace shadowbench::techniques
