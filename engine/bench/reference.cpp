#include "bench/reference.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "base/random.h"
#include "bench/gather.h"
#include "bench/ray_sets.h"
#include "bench/reference_traced.h"
#include "rays/capture.h"
#include "rays/light_rays.h"
#include "rays/tracer.h"

namespace shadowbench::bench {
namespace {

using rays::LightRays;
using rays::MapLayout;
using techniques::Query;

// One set of rays.
struct RaySet {
    const MapLayout& layout;
    const rays::Capture& capture;
    GridsInLight media;
};

std::vector<Moments> gather_all(const RaySet& set, std::span<const Query> queries, Gather gather,
                                const ReferenceWatch& watch) {
    const MapLayout& layout = set.layout;
    std::vector<std::vector<Part>> parts = parts_by_tile(layout, queries);
    std::vector<std::size_t> tiles;
    for (std::size_t t = 0; t < parts.size(); ++t)
        if (!parts[t].empty()) tiles.push_back(t);

    const std::size_t in_flight = 4 * static_cast<std::size_t>(base::thread_count());
    for (std::size_t first = 0; first < tiles.size(); first += in_flight) {
        base::parallel_for(std::min(in_flight, tiles.size() - first), [&](std::size_t i) {
            std::vector<Part>& tile_parts = parts[tiles[first + i]];
            const int index = static_cast<int>(tiles[first + i]);
            const LightRays tile = set.capture.tile(index);
            gather(tile, layout, queries, set.media, tile_parts);
        });
        if (watch) watch(std::min(first + in_flight, tiles.size()), tiles.size());
    }
    return reduce(parts, queries.size());
}

// The casters of one light without grid volumes, whose extinction varies within a segment.
struct Casters {
    Casters(const scene::Scene& all, const rays::LightView& in, const MapLayout& map)
        : scene(all), layout(map), capture(all, in, map, rays::Capture::Grids::left_out), grids(all, true), view(in) {}

    // Calls visit(index, set) for each of the sets. Each has the seed of the layout and of its index.
    template <class Visit>
    void for_each_set(int sets, const Visit& visit) const {
        for (int k = 0; k < sets; ++k) {
            MapLayout own = layout;
            own.seed = base::hash(layout.seed, 0x73657473u, static_cast<std::uint64_t>(k));
            const rays::Capture rays(capture, own.seed);
            visit(k, RaySet{own, rays, {grids, view}});
        }
    }

    const scene::Scene& scene;
    const MapLayout& layout;
    rays::Capture capture;
    rays::GridMedia grids;
    const rays::LightView& view;
};

std::vector<Moments> gather_one_set(const Casters& casters, std::span<const Query> queries,
                                    const ReferenceWatch& watch) {
    const RaySet set{casters.layout, casters.capture, {casters.grids, casters.view}};
    const auto sums_of = [&](std::span<const Query> asked, Gather gather) {
        return gather_all(set, asked, gather, gather == gather_footprints ? watch : ReferenceWatch());
    };
    if (casters.scene.deep_image) return gather_or_nearest(queries, sums_of);  // there is nothing to trace
    std::vector<Moments> moments = sums_of(queries, gather_footprints);
    const EmptyFootprints empty = empty_footprints(queries, [&](std::size_t q) { return moments[q].count > 0; });
    if (empty.query.empty()) return moments;
    const rays::Tracer tracer(casters.scene, true);
    const std::vector<Moments> traced = trace_footprints(tracer, casters.view, casters.layout, empty.query);
    for (std::size_t i = 0; i < traced.size(); ++i) moments[empty.place[i]] = traced[i];
    return moments;
}

SetSums gather_sets(const Casters& casters, int sets, std::span<const Query> queries, const ReferenceWatch& watch) {
    SetSums sums(queries.size(), static_cast<std::size_t>(sets), static_cast<std::size_t>(casters.layout.channels));
    casters.for_each_set(sets, [&](int k, const RaySet& set) {
        const auto of_all = [&](std::size_t done, std::size_t total) { watch(k * total + done, sets * total); };
        const std::vector<Moments> moments =
            gather_all(set, queries, gather_footprints, watch ? of_all : ReferenceWatch());
        for (std::size_t q = 0; q < queries.size(); ++q) sums.set(q, k, moments[q]);
    });
    const EmptyFootprints empty = empty_footprints(queries, [&](std::size_t q) { return !sums.empty(q); });
    if (empty.query.empty()) return sums;
    const rays::Tracer tracer(casters.scene, true);
    casters.for_each_set(sets, [&](int k, const RaySet& set) {
        const std::vector<Moments> traced = trace_footprints(tracer, casters.view, set.layout, empty.query);
        for (std::size_t i = 0; i < traced.size(); ++i) sums.set(empty.place[i], k, traced[i]);
    });
    return sums;
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

RaySets ray_sets(const scene::Scene& scene, const scene::RaySettings& settings) {
    if (scene.deep_image) return {};
    const int samples = settings.samples_per_pixel;
    if (settings.pattern != scene::Pattern::jittered) return {1, samples};
    if (samples < 16) return {samples, 1};
    return {8, samples / 8};
}

scene::RaySettings settings_of_a_set(const scene::Scene& scene, const scene::RaySettings& settings) {
    scene::RaySettings own = settings;
    own.samples_per_pixel = ray_sets(scene, settings).samples_per_pixel;
    return own;
}

Truth reference_visibility(const scene::Scene& scene, const rays::LightView& view, const scene::RaySettings& settings,
                           std::span<const Query> queries, const ReferenceWatch& watch) {
    const RaySets plan = ray_sets(scene, settings);
    MapLayout layout = rays::make_layout(scene, view, settings_of_a_set(scene, settings));
    layout.multi_jittered = plan.sets > 1;
    // Whole tiles are captured around the queries: no larger ones for fewer rays a set.
    const MapLayout whole = rays::make_layout(scene, view, settings);
    layout.tile_width = whole.tile_width;
    layout.tile_height = whole.tile_height;
    const Casters casters(scene, view, layout);

    Truth truth;
    truth.channels = layout.channels;
    truth.degrees = plan.sets - 1;
    truth.samples_per_pixel = plan.sets * layout.samples();
    truth.value.reserve(queries.size() * layout.channels);
    truth.standard_error.reserve(queries.size() * layout.channels);
    const auto add = [&](const Mean& mean) {
        truth.value.push_back(mean.value);
        truth.standard_error.push_back(scene.deep_image ? 0.0 : mean.standard_error);
    };
    if (plan.sets == 1) {
        const std::vector<Moments> moments = gather_one_set(casters, queries, watch);
        for (int c = 0; c < layout.channels; ++c)
            for (const Moments& m : moments) add(mean_of_rays(m, c));
    } else {
        const SetSums sums = gather_sets(casters, plan.sets, queries, watch);
        for (int c = 0; c < layout.channels; ++c)
            for (std::size_t q = 0; q < queries.size(); ++q)
                add(mean_of_sets(sums.of(q, static_cast<std::size_t>(c)), sums.counts(q)));
    }
    return truth;
}

}  // namespace shadowbench::bench
