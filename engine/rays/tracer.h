// Traces rays through the scene with Embree: the independent check of the capture, the camera's rays, and the shadow
// rays of the ray-traced technique.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "base/vec.h"
#include "rays/light_view.h"

namespace shadowbench::scene {
struct Scene;
}

namespace shadowbench::rays {

// A segment in the ray's own parameter t (world length if the direction has unit length).
struct TracedSegment {
    double front, back;  // equal for a surface
    base::Vec3d transmittance;
};

struct SurfaceHit {
    double t = 0.0;
    base::Vec3d position{0, 0, 0};
    base::Vec3d normal{0, 0, 0};   // unit length, faces the ray's origin; for hair, across the strand
    base::Vec3d tangent{0, 0, 0};  // unit length, along the strand; 0 for other primitives
    base::Vec3d opacity{0, 0, 0};  // at the hit, texture included: each in [0, 1], one of them above 0
};

// For pictures: hair that is narrower than a view ray is as wide as one, and its opacity falls to the share of that
// width which it covers. Rays then meet every strand, instead of some of a strand's pixels. A view ray is 2 * half_width
// wide at depth 1 along `forward`, which has unit length.
struct ViewedHair {
    base::Vec3d eye{0, 0, 0}, forward{0, 0, -1};
    double half_width = 0.0;
};

// Thread-safe once constructed. Keeps a reference to the scene. `time`, in [0, 1], is the time in the shutter at which
// a ray sees the scene.
class Tracer {
public:
    Tracer(const scene::Scene& scene, bool casters_only);
    Tracer(const scene::Scene& scene, bool casters_only, const ViewedHair& viewed);
    ~Tracer();
    Tracer(const Tracer&) = delete;
    Tracer& operator=(const Tracer&) = delete;

    // Everything between t_min and t_max, sorted by front; all crossings at equal depth are kept. Grid volumes have one
    // segment for each voxel cell, or for each step to check rays that were captured with steps.
    enum class Grids { cells, steps };
    void all_segments(const base::Vec3d& origin, const base::Vec3d& direction, double t_min, double t_max,
                      std::vector<TracedSegment>& out, double time = 0.0, Grids grids = Grids::cells) const;

    // The surfaces that a ray meets, in order of depth, up to and including the first behind which no channel transmits
    // anything; returns true if there is one. Surfaces of opacity 0 are skipped. At equal depth all surfaces are kept,
    // in the order of the scene's objects; a ray through an edge that triangles of one mesh share meets one of them.
    bool surfaces(const base::Vec3d& origin, const base::Vec3d& direction, std::vector<SurfaceHit>& out,
                  double time = 0.0) const;

    // Whether the scene has media: all_segments may then return segments that are not surfaces.
    bool has_media() const;

    // Exact transmittance per channel of the light ray at map position (x, y) up to depth z (surfaces strictly before
    // z; grid volumes integrated up to z). `scratch`, reused between calls, receives the segments of everything else.
    base::Vec3d transmittance(const LightView& view, double x, double y, double z, std::vector<TracedSegment>& scratch,
                              double time = 0.0) const;

private:
    struct State;
    Tracer(const scene::Scene& scene, bool casters_only, const ViewedHair* viewed);
    std::unique_ptr<State> state_;
};

}  // namespace shadowbench::rays
