// Rays of the truth inside footprints in which none of its captured rays falls. Internal to reference.cpp.
#pragma once

#include <span>
#include <vector>

#include "bench/gather.h"
#include "rays/light_rays.h"
#include "rays/light_view.h"
#include "rays/tracer.h"
#include "techniques/technique.h"

namespace shadowbench::bench {

// Traces rays for each query: as many as a pixel of the layout has, spread over the part of the query's footprint that
// lies inside the map as those of a pixel are spread over the pixel, in place and in time. Where they lie depends on
// the layout's seed and on the query's place and width, so a truth never rises with depth. `casters` sees what casts
// shadows. The result does not depend on the number of threads.
std::vector<Moments> trace_footprints(const rays::Tracer& casters, const rays::LightView& view,
                                      const rays::MapLayout& layout, std::span<const techniques::Query> queries);

}  // namespace shadowbench::bench
