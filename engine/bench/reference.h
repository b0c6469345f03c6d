// The truth that lookups are judged against: the mean, over every light ray inside the footprint of a query, of its
// exact transmittance up to the query's depth. It uses rays of its own: more of them, with another seed. Steps and
// cells of grid volumes leave no error in it. In a footprint so narrow that none of these rays falls into it, it traces
// rays of its own.
//
// Rays spread evenly do not tell how far their mean is off: taken for independent, they claim up to ten times as much
// doubt as there is. So the rays form independent randomised sets, each spread evenly, and the sets' means tell it
// (replicated sampling: Owen, Monte Carlo Theory, Methods and Examples, 2013, chapter 17). This holds for every
// stratification, in place and in time.
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
    // Standard error of each value, with `degrees` degrees of freedom: a 95 % interval is the value -+ t times the
    // error, with Student's t of so many degrees. 0 if all rays of the footprint see the same: what lies between the
    // rays is unknown. A footprint so narrow that some sets miss it has a widened error, at most 0.5.
    std::vector<double> standard_error;
    // One less than the number of sets. 0 if there is only one: then the error is 0 if the rays are all there are (a
    // deep image), else the upper bound of rays taken for independent (a regular pattern, or one ray a pixel; 0.5 for a
    // single ray).
    int degrees = 0;
    int samples_per_pixel = 1;  // rays used, of all sets
};

// How the rays of the truth are divided: at least 16 a pixel make 8 sets, and a rest that 8 does not divide is left
// out; 2 to 15 make as many sets of one ray a pixel. A regular pattern and a deep image have one set.
struct RaySets {
    int sets = 1;
    int samples_per_pixel = 1;  // of each set
};
RaySets ray_sets(const scene::Scene& scene, const scene::RaySettings& settings);
scene::RaySettings settings_of_a_set(const scene::Scene& scene, const scene::RaySettings& settings);

// The rays from which the truth of a scenario is computed: its own samples and seed. A deep image's rays are all there
// are.
scene::RaySettings reference_settings(const scene::Scenario& scenario);

using ReferenceWatch = std::function<void(std::size_t done, std::size_t total)>;

// V*(x, y, z; w): averages the rays with |sx - x| <= w/2 and |sy - y| <= w/2 inside the map. If no set has a ray there,
// each set traces as many through the footprint as a pixel has, spread over it as over a pixel. Of a deep image, which
// has nothing to trace, it takes the ray of the sample cell of (x, y) then. Captures the tiles that the footprints
// touch, a few at a time. The rays of a set are multi-jittered (light_rays.h). Each set has a seed of its own, made
// from that of the settings. The result does not depend on the number of threads.
Truth reference_visibility(const scene::Scene& scene, const rays::LightView& view, const scene::RaySettings& settings,
                           std::span<const techniques::Query> queries, const ReferenceWatch& watch);

}  // namespace shadowbench::bench
