#include "techniques/deep/deep.h"

#include <algorithm>
#include <memory>

#include "techniques/deep/deep_map.h"
#include "techniques/deep/deep_parameters.h"
#include "techniques/deep/mip.h"

namespace shadowbench::techniques {
namespace {

using namespace deep_parameters;

class Deep final : public Map {
public:
    explicit Deep(const ParameterValues& values) : values_(values) {
        map_.compression.method = method_of(values);
        map_.filter = filter_of(values);
        map_.rule = rule_of(values);
        map_.levels_of_samples = has_levels_of_samples(values);
    }

    // A map of given functions, one pixel high. It has no rays to filter.
    Deep(const ParameterValues& values, std::span<const curves::Curve> functions) : Deep(values) {
        map_.compression.tolerance = static_cast<float>(tolerance_of(values, 1));
        map_.filter = {};
        map_.make(functions);
        store();
    }

    RayNeeds needs() const override { return {.apron = map_.filter.apron(), .functions = map_.filter.is_pixel()}; }
    void begin(const BuildInput& input) override {
        map_.compression.tolerance = static_cast<float>(tolerance_of(values_, input.layout.samples()));
        map_.begin(input.layout);
        channels_ = input.layout.channels;
        notes_.z_min = input.layout.z_min;
        notes_.z_max = input.layout.z_max;
    }
    void add(const rays::LightRays& tile) override { map_.add(tile); }
    void add_functions(const rays::LightRays& tile, const curves::RayFunctions& functions) override {
        map_.add(tile, &functions);
    }
    void finish() override {
        map_.finish();
        store();
    }
    void set_lookups(const ParameterValues& values) override { map_.rule = rule_of(values); }

    int channels() const override { return channels_; }
    void lookup(std::span<const Query> queries, std::span<float> visibility) const override {
        lookup_shaped(queries, {}, visibility);
    }
    void lookup_shaped(std::span<const Query> queries, std::span<const Footprint> footprints,
                       std::span<float> visibility) const override {
        if (tiled_) return tiled_->lookup(map_.rule, queries, footprints, visibility);
        techniques::lookup(map_.levels, map_.rule, queries, footprints, visibility);
    }
    void touched(const Query& query, std::vector<const void*>& lines) const override {
        touched_shaped(query, {}, lines);
    }
    void touched_shaped(const Query& query, const Footprint& footprint,
                        std::vector<const void*>& lines) const override {
        if (tiled_) return tiled_->touched(map_.rule, query, footprint, lines);
        techniques::touched(map_.levels, map_.rule, query, footprint, lines);
    }
    std::size_t bytes() const override {
        return tiled_ ? tiled_->bytes() + stats_.histogram.capacity() * sizeof(std::uint64_t) : map_.bytes();
    }
    std::size_t working_bytes() const override { return std::max(map_.peak_bytes, bytes()); }
    NodeStats nodes() const override { return tiled_ ? stats_ : map_.stats(); }

    Cells cells() const override { return map_.filter.is_pixel() ? Cells::pixel : Cells::filtered; }
    void stored(int x, int y, int channel, std::span<const float>, curves::Curve& out) const override {
        if (tiled_) return tiled_->stored(x, y, channel, out);
        read_function(map_.levels[0], map_.levels[0].pixel(x, y), channel, out);
    }
    void weights(int x, int y, const rays::LightRays& tile, std::vector<curves::WeightedRay>& out) const override {
        map_.weights(x, y, tile, out);
    }
    std::optional<FewestNodes> fewest_nodes(int x, int y, const rays::LightRays& tile) const override {
        return map_.fewest_nodes(x, y, tile);
    }

    std::span<const DeepLevel> levels() const { return map_.levels; }
    std::optional<TileCounts> tiles() const { return tiled_ ? std::optional(tiled_->counts()) : std::nullopt; }

private:
    // Called once the levels are complete.
    void store() {
        const std::size_t slots = slots_of(values_);
        if (slots == 0) return;
        stats_ = map_.stats();
        notes_.tolerance = map_.compression.tolerance;
        tiled_ = std::make_unique<const TiledMap>(map_.levels, slots, notes_);
        map_.levels = {};
    }

    ParameterValues values_;
    DeepMap map_;
    std::unique_ptr<const TiledMap> tiled_;  // holds the finished map, and map_ has no levels; null: in memory
    DeepFileNotes notes_;                    // of the tiles' file
    NodeStats stats_;                        // of a map in tiles
    int channels_ = 1;
};

// In memory, the offsets, colour flags and padding that every level has; in tiles, the directory of the whole tiles of
// level 0.
std::size_t least_bytes(const ParameterValues& values, const rays::MapLayout& layout) {
    const int levels = values.word("mip") == "none" ? 1 : mip_levels(layout.width, layout.height);
    if (slots_of(values) > 0)
        return static_cast<std::size_t>(layout.width / tile_side) *
               static_cast<std::size_t>(layout.height / tile_side) * 2 * sizeof(std::uint64_t);
    std::size_t sum = 0;
    for (int l = 0; l < levels; ++l) {
        const std::size_t pixels = static_cast<std::size_t>(mip_size(layout.width, l)) * mip_size(layout.height, l);
        sum += (pixels + 1) * sizeof(std::uint32_t) + DeepLevel::padding * sizeof(float);
        if (layout.channels == 3) sum += (pixels + 63) / 64 * sizeof(std::uint64_t);
    }
    return sum;
}

}  // namespace

std::span<const DeepLevel> levels(const Map& map) {
    const auto* deep = dynamic_cast<const Deep*>(&map);
    return deep ? deep->levels() : std::span<const DeepLevel>();
}

std::optional<TileCounts> tiles(const Map& map) {
    const auto* deep = dynamic_cast<const Deep*>(&map);
    return deep ? deep->tiles() : std::nullopt;
}

Technique deep() {
    return {.id = "deep",
            .title = "deep shadow map: visibility functions compressed within a tolerance",
            .paper = "Lokovic, Veach 2000",
            .version = 4,
            .parameters = deep_parameters::all(),
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
                const bool bounded = method_of(values) != Compression::Method::published;
                return {.monotone = bounded, .unit_range = bounded};
            },
            // Values that are twice the tolerance apart are joined or not depending on their rounding, and so on the
            // order of their sums: no two products of round numbers are twice this apart.
            .traits = {.pointwise = {{"mip", "none"}, {"kernel", "box"}},
                       .order_free = {{"tolerance", 0.0131}},
                       .whole_pixel = {{"filter", "box"}, {"radius", 0.5}},
                       .trades = deep_parameters::trades()}};
}

}  // namespace shadowbench::techniques
