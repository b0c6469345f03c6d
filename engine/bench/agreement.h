// Compares the capture with an independent way to the same rays: Embree's all-hits query.
#pragma once

#include <cstddef>

#include "rays/capture.h"
#include "rays/light_view.h"
#include "rays/tracer.h"
#include "results/result.h"

namespace shadowbench::bench {

// Captures tiles spread over the map on one thread, then traces up to `max_rays` of their rays on one thread. `tracer`
// sees the casters. Only the layout decides which rays are compared. A ray that differs only because it passes through
// an edge does not count: Embree must differ from it also where the ray is moved by a thousandth of a pixel.
results::Agreement compare_with_tracer(const rays::Capture& capture, const rays::MapLayout& layout,
                                       const rays::LightView& view, const rays::Tracer& tracer, std::size_t max_rays);

}  // namespace shadowbench::bench
