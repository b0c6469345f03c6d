// What a light's run will hold, estimated before any of it is done.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "bench/contender.h"
#include "rays/light_rays.h"
#include "rays/light_view.h"
#include "scene/scene.h"

namespace shadowbench::bench {

struct MemoryLimits {
    std::size_t all = std::size_t{16} << 30;       // bytes; a run that surely needs more is refused
    std::size_t kept_rays = std::size_t{4} << 30;  // light rays beyond this are captured anew for every pass
};

// Bytes that a run holds at least: the light rays that are kept or in flight with one crossing a ray, what is kept of
// every tile, and the larger of what finding the truth needs and what the maps surely hold.
double least_bytes(const rays::MapLayout& layout, const rays::MapLayout& reference,
                   std::span<const Contender> contenders, const MemoryLimits& limits);

// The bytes that a scenario needs at least. Throws Error{bad_input} at `where` when that is more than the limit.
double check_memory(const scene::Scenario& scenario, const rays::LightView& view, std::span<const Contender> contenders,
                    const MemoryLimits& limits, const std::string& where);

}  // namespace shadowbench::bench
