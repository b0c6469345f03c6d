// How long a run will take, guessed before any of it is done.
#pragma once

#include <cstddef>

#include "rays/light_rays.h"
#include "scene/scene.h"

namespace shadowbench::bench {

// Seconds of one light's run with so many techniques. A coarse guess by what its parts took on two cores of 2020, for
// refusing what would run for hours: the committed scenarios take between a third and three times as long.
double estimate_seconds(const scene::Scenario& scenario, const rays::MapLayout& layout, std::size_t techniques);

}  // namespace shadowbench::bench
