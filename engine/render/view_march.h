// What a view ray meets, as shares of what the eye sees: steps through media, at which light is looked up, and
// surfaces.
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"
#include "rays/tracer.h"

namespace shadowbench::render {

// One step: where light is looked up, and the share of it that the step scatters to the eye per unit of albedo. With
// extinction sigma and transmittance T towards the eye that is the integral of sigma T over the step. Of media it is T
// at the step's front minus T at its back, whatever the extinction does in between (single scattering); a surface
// within the step takes its part of T from where it stands.
struct ViewStep {
    double t;
    base::Vec3d share;
};

struct ViewMarch {
    std::vector<ViewStep> steps;
    std::vector<base::Vec3d> surfaces;   // what is seen of each: T in front of it times its own opacity
    base::Vec3d transmittance{1, 1, 1};  // of all media and surfaces
};

// Composites along a ray. Media have constant extinction on each of `segments` (sorted by front; they may overlap;
// surfaces among them are passed over). Each stretch of media is cut into equal steps of at most `step`; a gap shorter
// than a step does not end a stretch, nor does a surface. `surfaces` are in order of depth. Steps and surfaces end
// where less than 1e-4 of the light is left in every channel: out.surfaces may be shorter than `surfaces`. `out` is
// replaced.
void march_view_ray(std::span<const rays::TracedSegment> segments, std::span<const rays::SurfaceHit> surfaces,
                    double step, ViewMarch& out);

}  // namespace shadowbench::render
