// One light of a scenario made ready for capture: its view and its layout.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "bench/contender.h"
#include "bench/memory.h"
#include "rays/light_rays.h"
#include "rays/light_view.h"
#include "scene/scene.h"

namespace shadowbench::bench {

struct PreparedLight {
    rays::LightView view;
    rays::MapLayout layout;    // with everything that the contenders need
    double least_bytes = 0.0;  // of a run with the contenders: see memory.h
};

// Prepares the light with this index. Throws Error{bad_input} at its pointer if it cannot see the scene, and at "/rays"
// if it needs more than the memory limit.
PreparedLight prepare_light(const scene::Scenario& scenario, std::size_t light, std::span<const Contender> contenders,
                            const MemoryLimits& limits);

}  // namespace shadowbench::bench
