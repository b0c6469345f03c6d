// Composites a view ray: steps through media, at which light is looked up, and surfaces, with their shares of what the
// eye sees.
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"
#include "rays/tracer.h"

namespace shadowbench::render {

// One step: where light is looked up, and the share of it that the step scatters to the eye per unit of albedo. With
// extinction sigma and transmittance T towards the eye, that is the integral of sigma T over the step. For media this
// equals T at the step's front minus T at its back, however the extinction varies in between (single scattering). A
// surface within the step removes its part of T from its own depth on.
struct ViewStep {
    double t;
    base::Vec3d share;
};

struct ViewMarch {
    std::vector<ViewStep> steps;
    std::vector<base::Vec3d> surfaces;   // visible share of each: T in front of it times its own opacity
    base::Vec3d transmittance{1, 1, 1};  // of all media and surfaces
};

// Composites along a ray. Media have constant extinction on each of `segments` (sorted by front; they may overlap;
// surfaces among them are skipped). Each stretch of media is cut into equal steps of at most `step`; neither a gap
// shorter than a step nor a surface ends a stretch. `surfaces` are in order of depth. Steps and surfaces end where less
// than 1e-4 of the light is left in every channel, so out.surfaces may be shorter than `surfaces`. `out` is replaced.
void march_view_ray(std::span<const rays::TracedSegment> segments, std::span<const rays::SurfaceHit> surfaces,
                    double step, ViewMarch& out);

}  // namespace shadowbench::render
