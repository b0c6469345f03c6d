#include "bench/agreement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/random.h"
#include "bench/clock.h"
#include "rays/light_rays.h"

namespace shadowbench::bench {
namespace {

using base::Vec3d;
using rays::LightRays;
using rays::MapLayout;

constexpr std::size_t timed_rays = std::size_t{1} << 18;  // captured at least, on one thread, if there are so many
// How far a ray is moved, in pixels: far enough that floats can tell, and that a ray through an edge leaves it.
constexpr double move = 1e-3;
constexpr double same_transmittance = 1e-3;  // texture coordinates are floats: 1e-4 of a texel, and so of its alpha

struct TracedRay {
    Vec3d origin, direction;  // unit length
    double t_min, t_max;
    double time;  // in the shutter
};

// The ray at a map position, from just before the first caster to just behind the last.
TracedRay ray_at(const rays::LightView& view, double x, double y, double time) {
    const double margin = 1e-3 * (view.z_max - view.z_min) + 1e-9;
    const double start = view.perspective ? view.z_near : view.z_min - margin;
    const double stretch = rays::length_per_depth(view, x, y);
    const Vec3d at = rays::to_world(view, rays::unproject(view, x, y, start));
    const Vec3d ahead = rays::to_world(view, rays::unproject(view, x, y, start + (view.z_max - view.z_min) + 1.0));
    return {at, (ahead - at).normalized(), 0.0, (view.z_max + margin - start) * stretch, time};
}

// The tracer, taking grid volumes as the capture does.
struct Check {
    const rays::Tracer& tracer;
    rays::Tracer::Grids grids;
};

void trace(const Check& check, const TracedRay& ray, std::vector<rays::TracedSegment>& out) {
    check.tracer.all_segments(ray.origin, ray.direction, ray.t_min, ray.t_max, out, ray.time, check.grids);
}

struct Crossed {
    std::size_t surfaces = 0;
    double transmittance[3] = {1.0, 1.0, 1.0};
};

Crossed crossed(const LightRays& tile, std::size_t ray) {
    Crossed result;
    for (std::uint32_t s = tile.begin[ray]; s < tile.begin[ray + 1]; ++s)
        result.surfaces += tile.z_front[s] == tile.back(s);
    for (int c = 0; c < 3; ++c)
        result.transmittance[c] =
            rays::transmittance(tile, ray, std::min(c, tile.channels - 1), std::numeric_limits<double>::infinity());
    return result;
}

Crossed crossed(const std::vector<rays::TracedSegment>& segments) {
    Crossed result;
    for (const rays::TracedSegment& segment : segments) {
        result.surfaces += segment.front == segment.back;
        for (int c = 0; c < 3; ++c) result.transmittance[c] *= segment.transmittance[c];
    }
    return result;
}

// Tiles in an order that depends only on the layout and spreads the first few over the map.
std::vector<int> spread_tiles(const MapLayout& layout) {
    std::vector<int> order(static_cast<std::size_t>(layout.tiles()));
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    base::Random random(base::hash(static_cast<std::uint64_t>(layout.tiles())));
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    return order;
}

struct ChosenRay {
    const LightRays* tile;
    std::size_t ray;
    rays::SamplePosition place;
    TracedRay traced;
};

ChosenRay choose(const LightRays& tile, const MapLayout& layout, const rays::LightView& view, std::size_t ray) {
    const std::size_t samples = static_cast<std::size_t>(tile.samples);
    const int pixel = static_cast<int>(ray / samples), sample = static_cast<int>(ray % samples);
    const int i = (tile.x0 + pixel % tile.width) * layout.samples_x + sample % layout.samples_x;
    const int j = (tile.y0 + pixel / tile.width) * layout.samples_y + sample / layout.samples_x;
    const rays::SamplePosition place = rays::sample_position(layout, i, j);
    return {&tile, ray, place, ray_at(view, place.x, place.y, rays::sample_time(layout, i, j))};
}

// The least and the greatest of what some rays cross.
struct Range {
    Crossed least, greatest;

    explicit Range(const Crossed& first) : least(first), greatest(first) {}
    void add(const Crossed& next) {
        least.surfaces = std::min(least.surfaces, next.surfaces);
        greatest.surfaces = std::max(greatest.surfaces, next.surfaces);
        for (int c = 0; c < 3; ++c) {
            least.transmittance[c] = std::min(least.transmittance[c], next.transmittance[c]);
            greatest.transmittance[c] = std::max(greatest.transmittance[c], next.transmittance[c]);
        }
    }
    bool has_surfaces(const Crossed& of) const {
        return least.surfaces <= of.surfaces && of.surfaces <= greatest.surfaces;
    }
    bool has_transmittance(const Crossed& of) const {
        for (int c = 0; c < 3; ++c)
            if (of.transmittance[c] < least.transmittance[c] - same_transmittance ||
                of.transmittance[c] > greatest.transmittance[c] + same_transmittance)
                return false;
        return true;
    }
};

// What Embree finds around a ray: it is moved by a small part of a pixel in four directions, none of them along the
// axes or the diagonals, where edges often lie.
Range around(const ChosenRay& ray, const rays::LightView& view, const Check& check,
             std::vector<rays::TracedSegment>& segments) {
    constexpr double cosine = 0.9238795325112867 * move, sine = 0.3826834323650898 * move;  // of 22.5 degrees
    const auto moved = [&](double x, double y) {
        trace(check, ray_at(view, ray.place.x + x, ray.place.y + y, ray.traced.time), segments);
        return crossed(segments);
    };
    Range range(moved(cosine, sine));
    range.add(moved(-sine, cosine));
    range.add(moved(-cosine, -sine));
    range.add(moved(sine, -cosine));
    return range;
}

// A ray through an edge that two triangles share crosses the surface once, but Embree reports both. A ray through an
// outer edge may hit it or not. Neither is a disagreement: where a captured ray differs from the traced one, it must
// lie among those that Embree finds around it. The captured ray is not moved, so a surface that the capture counts
// twice, or not at all, still shows.
void compare(const std::vector<ChosenRay>& chosen, const rays::LightView& view, const Check& check,
             results::Agreement& agreement) {
    std::vector<rays::TracedSegment> segments;
    for (const ChosenRay& ray : chosen) {
        trace(check, ray.traced, segments);
        const Crossed ours = crossed(*ray.tile, ray.ray);
        const Range here(crossed(segments));
        if (here.has_surfaces(ours) && here.has_transmittance(ours)) continue;
        const Range beside = around(ray, view, check, segments);
        agreement.other_crossings += !here.has_surfaces(ours) && !beside.has_surfaces(ours);
        agreement.other_transmittance += !here.has_transmittance(ours) && !beside.has_transmittance(ours);
    }
    agreement.rays = chosen.size();
}

double rate_of_tracer(const std::vector<ChosenRay>& chosen, const Check& check) {
    std::vector<rays::TracedSegment> segments;
    const Stopwatch stopwatch;
    for (const ChosenRay& ray : chosen) trace(check, ray.traced, segments);
    return static_cast<double>(chosen.size()) / stopwatch.seconds();
}

}  // namespace

results::Agreement compare_with_tracer(const rays::Capture& capture, const MapLayout& layout,
                                       const rays::LightView& view, const rays::Tracer& tracer, std::size_t max_rays) {
    const base::ThreadLimit one_thread(1);
    std::vector<LightRays> tiles;
    std::size_t rays = 0;
    double seconds = 0.0;
    for (const int index : spread_tiles(layout)) {
        if (rays >= timed_rays) break;
        const Stopwatch stopwatch;
        tiles.push_back(capture.tile(index));
        seconds += stopwatch.seconds();
        rays += tiles.back().rays();
    }

    // Every n-th ray, in the order in which they were captured: neighbours stay neighbours for both.
    std::vector<ChosenRay> chosen;
    const std::size_t step = std::max<std::size_t>(1, (rays + max_rays - 1) / max_rays);
    std::size_t at = 0;
    for (const LightRays& tile : tiles)
        for (std::size_t ray = 0; ray < tile.rays(); ++ray, ++at)
            if (at % step == 0) chosen.push_back(choose(tile, layout, view, ray));

    results::Agreement agreement;
    const Check check{tracer, layout.cells ? rays::Tracer::Grids::cells : rays::Tracer::Grids::steps};
    compare(chosen, view, check, agreement);
    agreement.times.capture_rays_per_second = static_cast<double>(rays) / seconds;
    agreement.times.tracer_rays_per_second = rate_of_tracer(chosen, check);  // after compare() has warmed it up
    agreement.times.ratio = agreement.times.capture_rays_per_second / agreement.times.tracer_rays_per_second;
    return agreement;
}

}  // namespace shadowbench::bench
