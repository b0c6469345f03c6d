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
    std::size_t light;                  // its number
    const rays::Tracer* casters;        // null for a deep image
    std::span<const CameraPoint> seen;  // receivers in world space, with a camera
    MemoryLimits limits;
    StageWatch watch;
};

// Throws Error{bad_input}: no receiver is in the light's map, the memory limit is exceeded, or a technique cannot serve
// this layout. A fault of a technique is not an error: its cell is marked failed. Nor is a light that sees nothing: all
// is lit then, and every answer has to be 1.
results::LightResult run_light(const LightJob& job, std::vector<Contender> contenders);

}  // namespace shadowbench::bench
