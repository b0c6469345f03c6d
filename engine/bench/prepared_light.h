// One light of a scenario made ready to be captured: where it looks from, and what is captured for it.
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
    rays::MapLayout layout;    // with what the contenders need
    double least_bytes = 0.0;  // that a run with them holds, see memory.h
};

// JSON pointer of a light, or of the deep image that stands in its place.
std::string pointer_of(const scene::Scenario& scenario, std::size_t light);

// The light with this number. Throws Error{bad_input}: a light that cannot see the scene, at its pointer; more than the
// memory limit, at "/rays".
PreparedLight prepare_light(const scene::Scenario& scenario, std::size_t light, std::span<const Contender> contenders,
                            const MemoryLimits& limits);

}  // namespace shadowbench::bench
