// The receivers of a scenario with a camera: the places in the world that it sees.
#pragma once

#include <vector>

#include "base/vec.h"
#include "rays/image_plane.h"
#include "rays/tracer.h"
#include "scene/scene.h"

namespace shadowbench::bench {

// A place that a pixel of the camera sees, and the pixel's edges there: how far the place moves from one pixel to the
// next, to the right and downwards, on the tangent plane of the surface; in a medium, on the plane that faces the view
// ray. The edges are unbounded on a surface seen edge-on.
struct CameraPoint {
    base::Vec3d position;
    base::Vec3d across{0, 0, 0}, down{0, 0, 0};
    base::Vec3d normal{0, 0, 0};  // unit length; 0 in media and on hair, whose ribbons face every light
};

// The camera point of the pixel whose ray runs along `through` (of the plane) and sees `point` on a surface with this
// normal. Its edges are exact to first order in the pixel.
CameraPoint camera_point(const rays::ImagePlane& plane, const base::Vec3d& through, const base::Vec3d& point,
                         const base::Vec3d& normal);

// The same of a surface, with its normal.
CameraPoint camera_point(const rays::ImagePlane& plane, const base::Vec3d& through, const rays::SurfaceHit& hit);

// Draws one of the surfaces that a view ray meets (as from Tracer::surfaces, at least one) for u in [0, 1). The
// probability of each is its share of what is seen of all of them: the transmittance in front of it times its own
// opacity, the mean of the channels. Surfaces are in front of it and, in `segments` (as from Tracer::all_segments, or
// none), media. The draw inverts the cumulative share in order of depth: as the surfaces grow more opaque together, the
// surface drawn for one u can only come nearer. If the shares are too small for a double, the nearest surface is drawn.
std::size_t draw_surface(const std::vector<rays::SurfaceHit>& surfaces,
                         const std::vector<rays::TracedSegment>& segments, double u);

// For each pixel of the image: first `media_lookups` places spread evenly over the media along its view ray, up to the
// first surface behind which nothing is seen; then a place on one of the surfaces that the ray meets, drawn with one
// random number from the receivers' seed and the pixel. A pixel whose ray meets any surface of opacity above 0 has such
// a place, whatever the opacities. All is at mid-shutter. `tracer` sees all objects.
std::vector<CameraPoint> camera_points(const scene::Receivers& receivers, const rays::Tracer& tracer);

}  // namespace shadowbench::bench
