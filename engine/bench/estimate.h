// Estimates how long a run will take, before any work is done: counts rays, what they meet, builds, lookups and
// repetitions, and takes the time of each from one machine. See pace.h for others.
#pragma once

#include <cstddef>
#include <span>

#include "bench/contender.h"
#include "bench/expected_hits.h"
#include "rays/light_rays.h"
#include "scene/scene.h"

namespace shadowbench::bench {

// What the estimate of a light counts.
struct LightWork {
    double rays = 0.0;            // of its map
    double segments = 0.0;        // of a ray
    double pixels = 0.0;          // of the map
    double truth_rays = 0.0;      // captured for the judged queries
    double truth_samples = 0.0;   // rays in the footprint of one query of the truth
    double truth_pixel_rays = 0;  // rays a pixel of the truth
    double receivers = 0.0, judged = 0.0;
    double footprint = 0.0;  // rays of the map in the footprint of one lookup
    double spread_seeds = 0.0;
    double techniques = 0.0, traced = 0.0;  // that build a map; that trace rays for each lookup
    double channels = 1.0;
};

// `contenders`: none where a caller counts the work of its techniques itself.
LightWork count_work(const scene::Scenario& scenario, const rays::MapLayout& layout, const rays::LightView& view,
                     std::span<const Contender> contenders);

// Seconds for one light's run.
double estimate_seconds(const LightWork& work, const scene::Timing& timing, int threads);

// Seconds for loading a variant's scene: the structures for rays and the points that its camera sees.
double estimate_loading(const scene::Scenario& scenario, int threads);

// Seconds for the pictures of a scenario: the map of each light once more, and the truth and each technique at all
// points that the camera sees.
double estimate_pictures(const scene::Scenario& scenario, std::span<const LightWork> lights, int threads);

}  // namespace shadowbench::bench
