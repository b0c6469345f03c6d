// Estimates how long a run will take, before any work is done: counts rays, what they meet, builds, lookups and
// repetitions, and takes the time of each from one machine. See pace.h for others, and render/estimate.h for pictures.
#pragma once

#include <cstdint>

#include "bench/work.h"
#include "scene/scene.h"

namespace shadowbench::bench {

// Seconds for one light's run.
double estimate_seconds(const LightWork& work, const scene::Timing& timing, int threads);

// Seconds for reading and unpacking files of this many bytes.
double estimate_reading(std::uint64_t file_bytes);

// Seconds for preparing a variant: the structures for rays, of each tracer and of each light's captures, and the points
// that its camera sees.
double estimate_preparing(const scene::Scenario& scenario, int threads);

}  // namespace shadowbench::bench
