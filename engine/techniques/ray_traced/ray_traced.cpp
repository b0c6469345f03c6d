// Shadow rays through the scene for every lookup, without a map: the cost and quality of doing without the techniques.
#include <algorithm>
#include <bit>

#include "base/error.h"
#include "base/random.h"
#include "rays/light_view.h"
#include "rays/tracer.h"
#include "techniques/store/cells.h"

namespace shadowbench::techniques {
namespace {

const Parameter parameters[] = {
    {"samples", ParameterKind::integer, "rays per lookup, jittered over its footprint", 16, 1, 65536},
};

// One side of a footprint, cut to a map of this many pixels.
class Side {
public:
    Side(double middle, double width, int pixels)
        : low_(std::max(middle - 0.5 * width, 0.0)), length_(std::min(middle + 0.5 * width, pixels * 1.0) - low_) {}
    double at(double share) const { return low_ + share * length_; }

private:
    double low_, length_;
};

class RayTraced final : public Map {
public:
    explicit RayTraced(const ParameterValues& values) { rays::set_samples(pattern_, values.integer("samples")); }

    void begin(const BuildInput& input) override {
        if (!input.tracer)
            throw base::Error(base::ErrorCode::bad_input, "/techniques",
                              "ray_traced needs a scene to trace, but ready-made light rays have none; remove it");
        view_ = input.view;
        tracer_ = input.tracer;
        channel_ = input.channel;
        seed_ = input.layout.seed;
        pattern_.moving = input.layout.moving;
        pattern_.jittered = true;
    }
    void add(const rays::LightRays&) override {}
    void finish() override {}

    void lookup(std::span<const Query> queries, std::span<float> visibility) const override {
        const auto inside = [](double place, int count) { return place >= 0 && place < count; };
        std::vector<rays::TracedSegment> scratch;
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const Query& q = queries[i];
            visibility[i] = 1.0f;
            if (!inside(q.x, view_.resolution.x) || !inside(q.y, view_.resolution.y) || !(q.z > 0.0f)) continue;
            // The jitter depends only on the query and the seed of the rays; so do the times, which spread over the
            // shutter.
            const auto bits = [](float f) { return static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(f)); };
            const std::uint64_t key = base::hash(bits(q.x) << 32 | bits(q.y), bits(q.z), seed_);
            base::Random random(key);
            rays::MapLayout pattern = pattern_;
            pattern.seed = key;
            // The part of the footprint inside the map: a footprint that the map's edge cuts has as many samples.
            const Side across(q.x, width_of(q), view_.resolution.x), down(q.y, width_of(q), view_.resolution.y);
            double sum = 0.0;
            for (int sy = 0; sy < pattern_.samples_y; ++sy)
                for (int sx = 0; sx < pattern_.samples_x; ++sx) {
                    const double x = across.at((sx + random.uniform()) / pattern_.samples_x);
                    const double y = down.at((sy + random.uniform()) / pattern_.samples_y);
                    const double time = rays::sample_time(pattern, sx, sy);
                    sum += tracer_->transmittance(view_, x, y, q.z, scratch, time)[channel_];
                }
            visibility[i] = static_cast<float>(sum / pattern_.samples());
        }
    }
    void touched(const Query&, std::vector<const void*>&) const override {}

    std::size_t bytes() const override { return 0; }
    std::size_t working_bytes() const override { return 0; }
    NodeStats nodes() const override { return {}; }
    Cells cells() const override { return Cells::none; }
    void stored(int, int, int, std::span<const float>, curves::Curve& out) const override { out.clear(); }

private:
    rays::MapLayout pattern_;  // of one lookup
    rays::LightView view_;
    const rays::Tracer* tracer_ = nullptr;
    int channel_ = 0;
    std::uint64_t seed_ = 0;
};

}  // namespace

Technique ray_traced() {
    return {.id = "ray_traced",
            .title = "shadow rays through the scene, no map",
            .paper = "none: the cost of doing without",
            .version = 4,
            .parameters = parameters,
            .create = create_map<RayTraced>,
            .traits = {.traces = true,
                       .draws_samples = true,
                       .filters = false,
                       .trades = {{"samples", Trade::Scale::logarithmic, 1, 1024}}}};
}

}  // namespace shadowbench::techniques
