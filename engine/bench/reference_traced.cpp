#include "bench/reference_traced.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "base/parallel.h"
#include "base/random.h"
#include "rays/pixel_positions.h"

namespace shadowbench::bench {
namespace {

using techniques::Query;

// One side of a footprint, cut to a map of this many pixels.
struct Side {
    double low, length;

    Side(double middle, double width, int pixels) {
        const double half = width > 0.0 ? 0.5 * width : 0.0;
        low = std::max(middle - half, 0.0);
        length = std::min(middle + half, static_cast<double>(pixels)) - low;
    }
    double at(double share) const { return low + share * length; }
};

// The rays of one footprint as those of a map of one pixel.
rays::MapLayout pattern_of(const rays::MapLayout& layout, const Query& q) {
    const auto bits = [](float f) { return static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(f)); };
    rays::MapLayout pattern = layout;
    pattern.width = pattern.height = 1;
    pattern.seed = base::hash(layout.seed, bits(q.x) << 32 | bits(q.y), bits(q.width));
    return pattern;
}

}  // namespace

std::vector<Moments> trace_footprints(const rays::Tracer& casters, const rays::LightView& view,
                                      const rays::MapLayout& layout, std::span<const Query> queries) {
    std::vector<Moments> moments(queries.size());
    base::parallel_for(queries.size(), [&](std::size_t k) {
        thread_local std::vector<rays::SamplePosition> positions;
        thread_local std::vector<rays::TracedSegment> scratch;
        const Query& q = queries[k];
        const rays::MapLayout pattern = pattern_of(layout, q);
        const Side across(q.x, q.width, layout.width), down(q.y, q.width, layout.height);
        rays::pixel_positions(pattern, 0, 0, positions);
        for (int sample = 0; sample < pattern.samples(); ++sample) {
            const rays::SamplePosition& place = positions[static_cast<std::size_t>(sample)];
            const double time = rays::sample_time(pattern, sample % pattern.samples_x, sample / pattern.samples_x);
            const base::Vec3d through =
                casters.transmittance(view, across.at(place.x), down.at(place.y), q.z, scratch, time);
            for (int c = 0; c < layout.channels; ++c) moments[k].add(c, through[c]);
            ++moments[k].count;
        }
    });
    return moments;
}

}  // namespace shadowbench::bench
