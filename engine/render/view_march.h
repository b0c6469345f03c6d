// Media along a view ray, as steps at which light is looked up.
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"
#include "rays/tracer.h"

namespace shadowbench::render {

// One step: where light is looked up, and the share of it that the step scatters to the eye per unit of albedo. With
// extinction sigma and transmittance T towards the eye that is the integral of sigma T over the step, which is T at its
// front minus T at its back, whatever the extinction does in between (single scattering).
struct ViewStep {
    double t;
    base::Vec3d share;
};

struct ViewMarch {
    std::vector<ViewStep> steps;
    base::Vec3d transmittance{1, 1, 1};  // of all media
};

// Media whose extinction is constant on each of `segments` (sorted by front; they may overlap; surfaces among them are
// passed over). Each stretch of media is cut into equal steps of at most `step`; a gap shorter than a step does not end
// a stretch. Steps end where less than 1e-4 of the light is left. `out` is replaced.
void march_view_ray(std::span<const rays::TracedSegment> segments, double step, ViewMarch& out);

}  // namespace shadowbench::render
