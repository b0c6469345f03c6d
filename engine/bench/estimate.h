// Estimates how long a run will take, before any work is done.
#pragma once

#include <cstddef>

#include "rays/light_rays.h"
#include "scene/scene.h"

namespace shadowbench::bench {

// Seconds for one light's run with this number of techniques. A coarse guess from the times of its parts on two cores
// of 2020, meant for refusing runs of hours: the committed scenarios take between a third and three times as long.
double estimate_seconds(const scene::Scenario& scenario, const rays::MapLayout& layout, std::size_t techniques);

}  // namespace shadowbench::bench
