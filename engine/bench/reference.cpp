#include "bench/reference.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "base/random.h"
#include "bench/gather.h"
#include "rays/capture.h"
#include "rays/light_rays.h"

namespace shadowbench::bench {
namespace {

using rays::LightRays;
using rays::MapLayout;
using techniques::Query;

// For each tile, the queries whose footprint touches it.
std::vector<std::vector<Part>> parts_by_tile(const MapLayout& layout, std::span<const Query> queries) {
    std::vector<std::vector<Part>> parts(static_cast<std::size_t>(layout.tiles()));
    for (std::size_t q = 0; q < queries.size(); ++q) {
        const FilterBox f = filter_box(queries[q], layout);
        for (int ty = f.y0 / layout.tile_height; ty <= f.y1 / layout.tile_height; ++ty)
            for (int tx = f.x0 / layout.tile_width; tx <= f.x1 / layout.tile_width; ++tx)
                parts[static_cast<std::size_t>(ty) * layout.tiles_x() + tx].push_back({q, {}});
    }
    return parts;
}

// The parts are summed tile after tile, so the sums are the same for every number of threads.
std::vector<Moments> reduce(const std::vector<std::vector<Part>>& parts, std::size_t queries) {
    std::vector<Moments> total(queries);
    for (const std::vector<Part>& tile : parts)
        for (const Part& part : tile) {
            Moments& sum = total[part.query];
            for (int c = 0; c < 3; ++c) {
                sum.sum[c] += part.moments.sum[c];
                sum.squares[c] += part.moments.squares[c];
            }
            sum.count += part.moments.count;
        }
    return total;
}

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

Spread spread_over_seeds(const scene::Scene& scene, const rays::LightView& view, const scene::RaySettings& settings,
                         int seeds, std::span<const Query> queries, const ReferenceWatch& watch) {
    Spread spread;
    if (settings.pattern == scene::Pattern::regular || scene.deep_image || seeds < 2) return spread;
    std::vector<double> sum, squares;
    for (int s = 0; s < seeds; ++s) {
        scene::RaySettings other = settings;
        other.seed = base::hash(settings.seed, static_cast<std::uint64_t>(s) + 1);
        const Truth truth = reference_visibility(scene, view, other, queries, {});
        sum.resize(truth.value.size());
        squares.resize(truth.value.size());
        for (std::size_t i = 0; i < truth.value.size(); ++i) {
            sum[i] += truth.value[i];
            squares[i] += truth.value[i] * truth.value[i];
        }
        if (watch) watch(static_cast<std::size_t>(s) + 1, static_cast<std::size_t>(seeds));
    }
    double total = 0.0;
    for (std::size_t i = 0; i < sum.size(); ++i) {
        const double variance = std::max(0.0, (squares[i] - sum[i] * sum[i] / seeds) / (seeds - 1.0));
        total += variance;
        spread.max = std::max(spread.max, std::sqrt(variance));
    }
    if (!sum.empty()) spread.rms = std::sqrt(total / static_cast<double>(sum.size()));
    return spread;
}

}  // namespace shadowbench::bench
