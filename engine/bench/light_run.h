// One light of one scenario: capture, check, time.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "bench/contender.h"
#include "bench/memory.h"
#include "bench/queries.h"
#include "rays/tracer.h"
#include "results/result.h"
#include "scene/scene.h"

namespace shadowbench::bench {

using StageWatch = std::function<void(const char* stage, std::size_t done, std::size_t total)>;

struct LightJob {
    const scene::Scenario& scenario;
    std::size_t light;                  // its index
    const rays::Tracer* casters;        // null for a deep image
    std::span<const CameraPoint> seen;  // the camera's receivers in the world; none without a camera
    MemoryLimits limits;
    StageWatch watch;
    bool times = true;  // whether builds and lookups are timed
};

// Throws Error{bad_input} if no receiver is in the light's map, the memory limit is exceeded, or a technique cannot
// serve this layout. A fault of a technique is not an error: its cell is marked as failed. A light that sees no caster
// is not an error either: everything is lit, and every answer must be 1.
results::LightResult run_light(const LightJob& job, std::vector<Contender> contenders);

}  // namespace shadowbench::bench
