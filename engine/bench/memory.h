// Estimates the memory of a light's run before any work is done.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "bench/contender.h"
#include "bench/ray_source.h"
#include "rays/light_rays.h"
#include "rays/light_view.h"
#include "scene/scene.h"

namespace shadowbench::bench {

struct MemoryLimits {
    std::size_t all = std::size_t{16} << 30;       // bytes; a run that certainly needs more is refused
    std::size_t kept_rays = std::size_t{4} << 30;  // bytes; more light rays are captured again for every pass
    std::size_t held = 0;                          // bytes that the process holds besides, such as the scene
};

// A lower bound for the bytes of a run: the light rays in flight, with one crossing per ray; what is kept for every
// tile; and the larger of what the truth and the maps need at least. Light rays that are kept do not count: where they
// leave no room, they are captured again for every pass.
double least_bytes(const rays::MapLayout& layout, const rays::MapLayout& reference,
                   std::span<const Contender> contenders);

// A lower bound for the bytes of all light rays of a map, if they are kept.
double least_ray_bytes(const rays::MapLayout& layout);

// The least bytes that a scenario needs. Throws Error{bad_input} at `where` if they exceed the limit.
double check_memory(const scene::Scenario& scenario, const rays::LightView& view, std::span<const Contender> contenders,
                    const MemoryLimits& limits, const std::string& where);

// The resident bytes of the process, after what is free was returned; 0 where they are not known.
std::size_t resident_bytes();

// The limits of a light's work in a process that holds so many bytes already. Only so many light rays are kept as leave
// room for the least that these maps take, and for the largest of them once more, while its build is timed.
MemoryLimits limits_beside(std::size_t held, const rays::MapLayout& layout, std::span<const Contender> contenders,
                           MemoryLimits limits);

// The bytes that maps may take which are built once more, beside the finished maps and the light rays that are kept.
std::size_t room_beside(std::span<const Contender> contenders, const RaySource& source, const MemoryLimits& limits);

// Drops the kept light rays if they leave no room to build the largest of these finished maps once more.
void make_room(std::span<const Contender> contenders, RaySource& source, const MemoryLimits& limits);

}  // namespace shadowbench::bench
