#include "bench/reference.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "bench/gather.h"
#include "rays/capture.h"
#include "rays/light_rays.h"

namespace shadowbench::bench {
namespace {

using rays::LightRays;
using rays::MapLayout;
using techniques::Query;

using Gather = void (*)(const LightRays&, const MapLayout&, std::span<const Query>, const GridsInLight&,
                        std::span<Part>);

// The casters of one light without grid volumes, whose extinction varies within a segment.
struct Casters {
    Casters(const scene::Scene& scene, const rays::LightView& in, const MapLayout& map)
        : layout(map), capture(scene, in, map, rays::Capture::Grids::left_out), grids(scene, true), view(in) {}

    const MapLayout& layout;
    rays::Capture capture;
    rays::GridMedia grids;
    const rays::LightView& view;
};

std::vector<Moments> gather_all(const Casters& casters, std::span<const Query> queries, Gather gather,
                                const ReferenceWatch& watch) {
    const MapLayout& layout = casters.layout;
    std::vector<std::vector<Part>> parts = parts_by_tile(layout, queries);
    std::vector<std::size_t> tiles;
    for (std::size_t t = 0; t < parts.size(); ++t)
        if (!parts[t].empty()) tiles.push_back(t);

    const std::size_t in_flight = 4 * static_cast<std::size_t>(base::thread_count());
    for (std::size_t first = 0; first < tiles.size(); first += in_flight) {
        base::parallel_for(std::min(in_flight, tiles.size() - first), [&](std::size_t i) {
            std::vector<Part>& tile_parts = parts[tiles[first + i]];
            const int index = static_cast<int>(tiles[first + i]);
            const LightRays tile = casters.capture.tile(index);
            gather(tile, layout, queries, {casters.grids, casters.view}, tile_parts);
        });
        if (watch) watch(std::min(first + in_flight, tiles.size()), tiles.size());
    }
    return reduce(parts, queries.size());
}

// A footprint narrower than a sample cell may hold no ray at all.
void fill_empty(const Casters& casters, std::span<const Query> queries, std::vector<Moments>& moments) {
    std::vector<std::size_t> empty;
    std::vector<Query> asked;
    for (std::size_t q = 0; q < queries.size(); ++q)
        if (moments[q].count == 0) {
            empty.push_back(q);
            asked.push_back(queries[q]);
            asked.back().width = 0.0f;
        }
    if (empty.empty()) return;
    const std::vector<Moments> nearest = gather_all(casters, asked, gather_nearest, {});
    for (std::size_t i = 0; i < empty.size(); ++i) moments[empty[i]] = nearest[i];
}

double standard_error(const Moments& moments, int channel) {
    const double n = static_cast<double>(moments.count);
    if (n < 2.0) return 0.5;  // unknown for one ray: the largest deviation of values in [0, 1]
    const double variance = (moments.squares[channel] - moments.sum[channel] * moments.sum[channel] / n) / (n - 1.0);
    return std::sqrt(std::max(variance, 0.0) / n);
}

}  // namespace

scene::RaySettings reference_settings(const scene::Scenario& scenario) {
    scene::RaySettings settings = scenario.rays;
    if (scenario.scene.deep_image) return settings;
    settings.samples_per_pixel = scenario.reference.samples_per_pixel;
    settings.pattern = scene::Pattern::jittered;
    settings.seed = scenario.reference.seed;
    return settings;
}

Truth reference_visibility(const scene::Scene& scene, const rays::LightView& view, const scene::RaySettings& settings,
                           std::span<const Query> queries, const ReferenceWatch& watch) {
    const MapLayout layout = rays::make_layout(scene, view, settings);
    const Casters casters(scene, view, layout);
    std::vector<Moments> moments = gather_all(casters, queries, gather_footprints, watch);
    fill_empty(casters, queries, moments);

    Truth truth;
    truth.channels = layout.channels;
    for (int c = 0; c < layout.channels; ++c)
        for (const Moments& m : moments) {
            truth.value.push_back(m.count ? m.sum[c] / static_cast<double>(m.count) : 1.0);
            truth.standard_error.push_back(scene.deep_image ? 0.0 : standard_error(m, c));
        }
    return truth;
}

}  // namespace shadowbench::bench
