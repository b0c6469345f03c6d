// The truth that lookups are judged against: the mean, over every light ray inside the footprint of a query, of its
// exact transmittance up to the query's depth, from rays of its own (more of them, another seed). No step or cell of a
// grid volume shows in it.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "rays/light_view.h"
#include "scene/scene.h"
#include "techniques/technique.h"

namespace shadowbench::bench {

// Values stand channel after channel: that of query q in channel c at [c * queries + q].
struct Truth {
    int channels = 1;
    std::vector<double> value;
    // Standard error of the mean from the variance between the rays. Rays spread evenly (jittered cells) do better than
    // it says, so it is an upper bound. 0 where the rays are all there is (a deep image).
    std::vector<double> standard_error;
};

// The rays that the truth of a scenario is taken from: its own samples and seed; a deep image's rays are all there are.
scene::RaySettings reference_settings(const scene::Scenario& scenario);

using ReferenceWatch = std::function<void(std::size_t done, std::size_t total)>;

// V*(x, y, z; w): the rays with |sx - x| <= w/2 and |sy - y| <= w/2 inside the map; the ray of the sample cell of (x,
// y) when there are none. Captures the tiles that the footprints touch, a few at a time. The answer does not depend on
// the number of threads.
Truth reference_visibility(const scene::Scene& scene, const rays::LightView& view, const scene::RaySettings& settings,
                           std::span<const techniques::Query> queries, const ReferenceWatch& watch);

struct Spread {
    double rms = 0.0, max = 0.0;
};

// Standard deviation of that mean over `seeds` (at least 2) other seeds of the same settings, over the queries.
// All 0 for a regular pattern, which has no randomness.
Spread spread_over_seeds(const scene::Scene& scene, const rays::LightView& view, const scene::RaySettings& settings,
                         int seeds, std::span<const techniques::Query> queries, const ReferenceWatch& watch);

}  // namespace shadowbench::bench
