// The same light with other seeds of its rays: how much the rays' own means vary, and what every technique makes of
// each.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "bench/contender.h"
#include "bench/maps.h"
#include "bench/memory.h"
#include "bench/reference.h"
#include "rays/light_rays.h"
#include "rays/light_view.h"
#include "scene/scene.h"
#include "techniques/technique.h"

namespace shadowbench::bench {

struct OtherRays {
    const scene::Scene& scene;
    const techniques::BuildInput& input;  // of the light's own rays
    int seeds;                            // further ones
    MemoryLimits limits;
};

// Over the queries, the standard deviation of the mean of the rays inside the footprint.
struct Spread {
    double rms = 0.0, max = 0.0;
};

// For each further seed: captures the map's rays once, builds every technique that has not failed (untimed; the stored
// functions are not compared), and looks up the judged queries. Fills in Cell::over_seeds and Contender::seed_errors. A
// contender that fails with another seed fails, and its reason names that seed. The spread is that of the captured
// rays; grid volumes are marched as the layout says. One seed at a time: beside what is given, memory holds the rays
// and the maps of one seed, within the limits of a build. Seeds depend only on that of the layout.
//
// Does nothing, and the spread is 0, for rays that are not random (a regular pattern, a deep image) and for fewer than
// 2 seeds.
Spread measure_over_seeds(const OtherRays& rays, std::span<Contender> contenders, const Asked& judged,
                          const Truth& truth, const ReferenceWatch& watch);

}  // namespace shadowbench::bench
