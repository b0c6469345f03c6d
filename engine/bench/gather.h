// Sums the exact transmittance of all light rays of a tile over the footprints of queries. Segments of rays have
// constant extinction, so the truth keeps grid volumes out of them: it integrates those along the rays, up to each
// depth of a query. Internal to reference.cpp and over_seeds.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rays/grid_media.h"
#include "rays/light_rays.h"
#include "rays/light_view.h"
#include "techniques/technique.h"

namespace shadowbench::bench {

// Pixels [x0, x1] x [y0, y1] that hold every ray of a query's footprint.
struct FilterBox {
    double left, right, low, high;
    int x0, x1, y0, y1;
};
FilterBox filter_box(const techniques::Query& query, const rays::MapLayout& layout);

struct Moments {
    double sum[3] = {0.0, 0.0, 0.0}, squares[3] = {0.0, 0.0, 0.0};
    std::uint64_t count = 0;

    void add(int channel, double value) {
        sum[channel] += value;
        squares[channel] += value * value;
    }
};

// The contribution of one tile to one query.
struct Part {
    std::size_t query;
    Moments moments;
};

// For each tile, the queries whose footprint touches it.
std::vector<std::vector<Part>> parts_by_tile(const rays::MapLayout& layout, std::span<const techniques::Query> queries);

// The sums of each query, tile after tile, so that they are the same for every number of threads.
std::vector<Moments> reduce(const std::vector<std::vector<Part>>& parts, std::size_t queries);

// The grid volumes of the scene, and the light that made the rays.
struct GridsInLight {
    const rays::GridMedia& grids;
    const rays::LightView& view;
};

// Adds to each part the rays of this tile inside its query's footprint. Walks each ray once, front to back, for all
// queries whose footprints hold it.
void gather_footprints(const rays::LightRays& tile, const rays::MapLayout& layout,
                       std::span<const techniques::Query> queries, const GridsInLight& media, std::span<Part> parts);

// Adds the ray of the sample cell that holds (x, y), if it belongs to this tile.
void gather_nearest(const rays::LightRays& tile, const rays::MapLayout& layout,
                    std::span<const techniques::Query> queries, const GridsInLight& media, std::span<Part> parts);

// Either of the two.
using Gather = void (*)(const rays::LightRays&, const rays::MapLayout&, std::span<const techniques::Query>,
                        const GridsInLight&, std::span<Part>);

// Queries whose footprint holds no ray, since it is narrower than a sample cell.
struct EmptyFootprints {
    std::vector<std::size_t> place;  // in all queries
    std::vector<techniques::Query> query;
};

// holds(q): whether the footprint of query q holds a ray.
template <class Holds>
EmptyFootprints empty_footprints(std::span<const techniques::Query> queries, const Holds& holds) {
    EmptyFootprints empty;
    for (std::size_t q = 0; q < queries.size(); ++q)
        if (!holds(q)) {
            empty.place.push_back(q);
            empty.query.push_back(queries[q]);
        }
    return empty;
}

// The rays inside each footprint, or the nearest ray if there is none. `sums_of(queries, gather)` gathers over all
// tiles.
template <class SumsOf>
std::vector<Moments> gather_or_nearest(std::span<const techniques::Query> queries, const SumsOf& sums_of) {
    std::vector<Moments> moments = sums_of(queries, gather_footprints);
    EmptyFootprints empty = empty_footprints(queries, [&](std::size_t q) { return moments[q].count > 0; });
    if (empty.query.empty()) return moments;
    for (techniques::Query& query : empty.query) query.width = 0.0f;
    const std::vector<Moments> nearest = sums_of(std::span<const techniques::Query>(empty.query), gather_nearest);
    for (std::size_t i = 0; i < nearest.size(); ++i) moments[empty.place[i]] = nearest[i];
    return moments;
}

}  // namespace shadowbench::bench
