// Percentage closer filtering: Reeves, Salesin, Cook, Rendering Antialiased Shadows with Depth Maps, 1987.
#include <bit>
#include <type_traits>

#include <fmt/format.h>

#include "base/error.h"
#include "techniques/depth/cell_subset.h"
#include "techniques/depth/pcf_samples.h"
#include "techniques/store/depth_map.h"

namespace shadowbench::techniques {
namespace {

// The names of figure 4 of the paper; values that section 4.2 calls typical. Its biases of 0.3 and 0.4 are for worlds
// of 100 units; receivers carry the scenario's own bias, so none is added here by default.
const Parameter parameters[] = {
    {"num_samples", ParameterKind::integer, "number of depths compared in one lookup, about (NumSamples)", 16, 1, 4096},
    {"res_factor", ParameterKind::number, "widens the region (ResFactor); below 1 the map's aliases show", 3, 1, 1000},
    {"min_size", ParameterKind::number, "least half-size of the region in cells (MinSize)", 2, 0, 10000},
    {"min_samples", ParameterKind::integer,
     "least samples along each side of the region (MinSamples); a subset ignores it", 2, 1, 64},
    {"bias0", ParameterKind::number, "least bias of a sample, world length (Bias0)", 0, 0, 1e6},
    {"bias1", ParameterKind::number, "largest bias of a sample, world length (Bias1); at least bias0", 0, 0, 1e6},
    {"placement",
     ParameterKind::choice,
     "where the samples lie (figure 3): anywhere in the region's bounding box, Gaussian in it, jittered in it, or "
     "jittered in the region's own shape; published: jittered in the upper half of each part of the bounding box, as "
     "figure 4 prints it, which moves every shadow by a quarter of a part; subset: a random subset of the cells with "
     "their middles in the bounding box, each at most once, all if they are no more than num_samples (Lokovic, Veach "
     "2000, section 6)",
     0,
     0,
     0,
     "jittered",
     {"uniform", "gaussian", "jittered", "shape", "published", "subset"}},
    {"region",
     ParameterKind::number_or_word,
     "the region of the filter: a square of the query's width, the receiver's pixel mapped into the map (or that "
     "square if the pixel is not known), or a square of this many map pixels",
     0,
     1e-6,
     1e6,
     "query",
     {"query", "pixel"}},
    cells_parameter,
    storage_parameter,
};

Placement read_placement(const ParameterValues& values) {
    const std::string& word = values.word("placement");
    if (word == "uniform") return Placement::uniform;
    if (word == "gaussian") return Placement::gaussian;
    if (word == "published") return Placement::published;
    if (word == "subset") return Placement::subset;
    return word == "shape" ? Placement::shape : Placement::jittered;
}

// The key of a lookup's random numbers, which depends only on the query.
std::uint64_t key_of(const Query& q) {
    const std::uint64_t place =
        static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(q.x)) << 32 | std::bit_cast<std::uint32_t>(q.y);
    return base::mix(base::mix(place) ^ std::bit_cast<std::uint32_t>(q.z));
}

PcfSettings read_settings(const ParameterValues& v) {
    return {static_cast<float>(v.number("num_samples")), static_cast<float>(v.number("res_factor")),
            static_cast<float>(v.number("min_size")),    static_cast<float>(v.number("min_samples")),
            static_cast<float>(v.number("bias0")),       static_cast<float>(v.number("bias1"))};
}

class PercentageCloser final : public Map {
public:
    explicit PercentageCloser(const ParameterValues& v)
        : settings_(read_settings(v)),
          bias_range_(settings_.bias1 - settings_.bias0),
          placement_(read_placement(v)),
          pixel_(v.is_word("region") && v.word("region") == "pixel"),
          width_(v.is_word("region") ? 0.0f : static_cast<float>(v.number("region"))),
          depths_(v) {}

    void begin(const BuildInput& input) override {
        if (settings_.bias1 < settings_.bias0)
            throw base::Error(
                base::ErrorCode::bad_input, "/techniques",
                fmt::format("bias1 is {}: it must be at least bias0, {}", settings_.bias1, settings_.bias0));
        depths_.map.begin(input.layout);
    }
    void add(const rays::LightRays& tile) override { depths_.map.add(tile); }
    void finish() override { depths_.finish(); }
    void set_lookups(const ParameterValues& values) override { settings_ = read_settings(values); }

    void lookup(std::span<const Query> queries, std::span<float> visibility) const override {
        lookup_shaped(queries, {}, visibility);
    }
    void lookup_shaped(std::span<const Query> queries, std::span<const Footprint> footprints,
                       std::span<float> visibility) const override {
        read([&](const auto& depths, auto placement) {
            answer<placement.value>(depths, queries, footprints, visibility);
        });
    }

    void touched(const Query& q, std::vector<const void*>& lines) const override { touched_shaped(q, {}, lines); }
    void touched_shaped(const Query& q, const Footprint& footprint, std::vector<const void*>& lines) const override {
        const std::size_t before = lines.size();
        read([&](const auto& depths, auto placement) { touch<placement.value>(depths, q, footprint, lines); });
        keep_unique(lines, before);
    }

    std::size_t bytes() const override { return depths_.store.bytes(); }
    std::size_t working_bytes() const override { return depths_.working_bytes(); }
    NodeStats nodes() const override { return depths_.store.nodes(); }
    Cells cells() const override { return depths_.map.kind; }
    void stored(int x, int y, int, std::span<const float>, curves::Curve& out) const override {
        depths_.stored(x, y, out);
    }

private:
    // One lookup, before it samples.
    struct Place {
        float x, y;           // cells
        CellRange range;      // that its samples lie in
        bool inside;          // no sample leaves the map
        float known = -1.0f;  // the visibility, if it is known without sampling; else -1
    };

    const CellGrid& grid() const { return depths_.store.grid(); }

    // visit(a way to read the depths, a way to place samples as a constant)
    template <class Visit>
    void read(const Visit& visit) const {
        depths_.store.read([&](const auto& depths) {
            switch (placement_) {
                case Placement::uniform:
                    return visit(depths, constant<Placement::uniform>);
                case Placement::gaussian:
                    return visit(depths, constant<Placement::gaussian>);
                case Placement::jittered:
                    return visit(depths, constant<Placement::jittered>);
                case Placement::shape:
                    return visit(depths, constant<Placement::shape>);
                case Placement::published:
                    return visit(depths, constant<Placement::published>);
                case Placement::subset:
                    return visit(depths, constant<Placement::subset>);
            }
        });
    }
    template <Placement placement>
    static constexpr std::integral_constant<Placement, placement> constant{};

    Region region_of(float width, const Footprint& footprint) const {
        Region region;
        if (pixel_ && footprint_region(settings_, grid(), footprint, placement_ == Placement::shape, region))
            return region;
        return square_region(settings_, grid(), width_ > 0.0f ? width_ : width);
    }

    // Returns false if the point is lit whatever the map holds: outside the map. The printed code also asks for depths
    // behind the light; those are before every caster, and so lit, without a rule of their own.
    template <class Depths>
    bool find(const Depths& depths, const Region& region, const Query& q, Place& p) const {
        int cx, cy;
        if (!grid().find(q.x, q.y, cx, cy)) return false;
        p.x = q.x * grid().per_pixel_x;
        p.y = q.y * grid().per_pixel_y;
        const Extent e = extent(region, p.x, p.y);
        const float right = static_cast<float>(grid().width), top = static_cast<float>(grid().height);
        p.inside = e.x0 >= 0.0f && e.y0 >= 0.0f && e.x1 < right && e.y1 < top;
        if constexpr (Depths::bounded) {
            p.range = {static_cast<int>(std::max(e.x0, 0.0f)), static_cast<int>(std::min(e.x1, right - 1.0f)) + 1,
                       static_cast<int>(std::max(e.y0, 0.0f)), static_cast<int>(std::min(e.y1, top - 1.0f)) + 1};
            const DepthBounds bounds = depths.bounds(p.range);
            if (!(q.z > bounds.least + settings_.bias0))
                p.known = 1.0f;
            else if (p.inside && q.z > bounds.greatest + (settings_.bias0 + bias_range_))
                p.known = 0.0f;
        }
        return true;
    }

    bool holds(float x, float y) const {
        return x >= 0.0f && y >= 0.0f && x < static_cast<float>(grid().width) && y < static_cast<float>(grid().height);
    }

    // visit(x, y, u) for each sample; returns their number. Samples spread over their whole parts of the region,
    // unless they are placed as published.
    template <Placement placement, class Visit>
    int visit_samples(const Region& region, const Query& q, const Place& p, const Visit& visit) const {
        if constexpr (placement == Placement::subset)
            return for_each_in_subset(extent(region, p.x, p.y), p.x, p.y, static_cast<int>(settings_.num_samples),
                                      key_of(q), visit);
        else
            for_each_sample<placement>(region, p.x, p.y, key_of(q), visit);
        return region.ns * region.nt;
    }

    template <Placement placement, class Depths>
    float visible(const Depths& depths, const Region& region, const Query& q, const Place& p) const {
        if (p.known >= 0.0f) return p.known;
        if (DepthWindow window; p.inside && depths.window(p.range, window))
            return bias_range_ > 0.0f ? sample<placement, true, true>(window, region, q, p)
                                      : sample<placement, true, false>(window, region, q, p);
        return sample<placement, false, true>(depths, region, q, p);
    }

    // The share of the samples that are lit; those outside the map are. If `drawn`, each sample draws its bias;
    // otherwise all have one.
    template <Placement placement, bool inside, bool drawn, class Depths>
    float sample(const Depths& depths, const Region& region, const Query& q, const Place& p) const {
        int shadowed = 0;
        const int samples = visit_samples<placement>(region, q, p, [&](float x, float y, float u) {
            if (!inside && !holds(x, y)) return;
            const float bias = drawn ? settings_.bias0 + u * bias_range_ : settings_.bias0;
            shadowed += q.z > *depths.at(static_cast<int>(x), static_cast<int>(y)) + bias;
        });
        return 1.0f - static_cast<float>(shadowed) / static_cast<float>(samples);
    }

    template <Placement placement, class Depths>
    void answer(const Depths& depths, std::span<const Query> queries, std::span<const Footprint> footprints,
                std::span<float> visibility) const {
        const bool each = pixel_ && !footprints.empty();
        Region region;
        float width = -1.0f;  // the width that the region is for: most lookups have the same
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const Query& q = queries[i];
            if (each || q.width != width) {
                region = region_of(q.width, each ? footprints[i] : Footprint{});
                width = q.width;
            }
            Place p;
            visibility[i] = find(depths, region, q, p) ? visible<placement>(depths, region, q, p) : 1.0f;
        }
    }

    template <Placement placement, class Depths>
    void touch(const Depths& depths, const Query& q, const Footprint& footprint,
               std::vector<const void*>& lines) const {
        const Region region = region_of(q.width, footprint);
        Place p;
        if (!find(depths, region, q, p)) return;
        if constexpr (Depths::bounded) depths.touch_bounds(p.range, lines);
        if (p.known >= 0.0f) return;
        visit_samples<placement>(region, q, p, [&](float x, float y, float) {
            if (holds(x, y)) depths.touch(static_cast<int>(x), static_cast<int>(y), lines);
        });
    }

    PcfSettings settings_;
    float bias_range_;
    Placement placement_;
    bool pixel_;   // filters over the receiver's pixel
    float width_;  // filters over this width; 0: the query's
    StoredDepths depths_;
};

// `min_size` is a length in cells: the filter would depend on the map's resolution instead of the query alone.
// `min_samples` would hide the smallest numbers of samples. Not traded: the biases and `cells`, for the reasons of
// shadow_map; `region`, as the query asks for one; `placement`, since of those that fill the query's square jittered
// samples have the least noise for their time.
std::vector<Trade> pcf_trades() {
    return {{"num_samples", Trade::Scale::logarithmic, 1, 256, {}, true},
            {.parameter = "res_factor", .choices = {1.0, 3.0}, .only_lookups = true},
            {.parameter = "min_size", .choices = {0.0}},
            {.parameter = "min_samples", .choices = {1.0}},
            storage_trade};
}

}  // namespace

Technique pcf() {
    return {.id = "pcf",
            .title = "percentage closer filtering of a depth map",
            .paper = "Reeves, Salesin, Cook 1987",
            .version = 2,
            .promises = {.opaque_only = true},
            .parameters = parameters,
            .create = create_map<PercentageCloser>,
            .error_bound = [](const ParameterValues&, const rays::MapLayout&) { return 0.0; },
            .least_bytes = StoredDepths::least_bytes,
            .traits = {.draws_samples = true,
                       .beyond_footprint = true,
                       .filters = false,
                       .biases = {"bias0", "bias1"},
                       .pointwise = {{"region", "query"}, {"min_size", 0.0}},
                       .trades = pcf_trades()}};
}

}  // namespace shadowbench::techniques
