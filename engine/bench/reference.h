// The truth that lookups are judged against: the mean, over every light ray inside the footprint of a query, of its
// exact transmittance up to the query's depth. It uses rays of its own: more of them, with another seed. Steps and
// cells of grid volumes leave no error in it.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "rays/light_view.h"
#include "scene/scene.h"
#include "techniques/technique.h"

namespace shadowbench::bench {

// Values are stored channel after channel: that of query q in channel c at [c * queries + q].
struct Truth {
    int channels = 1;
    std::vector<double> value;
    // Standard error of the mean from the variance between the rays. It is an upper bound, since rays spread evenly
    // (jittered cells) do better. 0 if the rays are all there are (a deep image).
    std::vector<double> standard_error;
};

// The rays from which the truth of a scenario is computed: its own samples and seed. A deep image's rays are all there
// are.
scene::RaySettings reference_settings(const scene::Scenario& scenario);

using ReferenceWatch = std::function<void(std::size_t done, std::size_t total)>;

// V*(x, y, z; w): averages the rays with |sx - x| <= w/2 and |sy - y| <= w/2 inside the map, or takes the ray of the
// sample cell of (x, y) if there are none. Captures the tiles that the footprints touch, a few at a time. The result
// does not depend on the number of threads.
Truth reference_visibility(const scene::Scene& scene, const rays::LightView& view, const scene::RaySettings& settings,
                           std::span<const techniques::Query> queries, const ReferenceWatch& watch);

}  // namespace shadowbench::bench
