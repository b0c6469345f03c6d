// What a camera sees, as places in the world: the receivers of a scenario with a camera.
#pragma once

#include <vector>

#include "base/vec.h"
#include "rays/image_plane.h"
#include "rays/tracer.h"
#include "scene/scene.h"

namespace shadowbench::bench {

// A place that a pixel of the camera sees, and the pixel's edges there: how far the place moves from one pixel to the
// next, to the right and downwards, on the plane that touches the surface; in a medium, on the plane that faces the
// view ray. Without bound where the surface is seen from its side.
struct CameraPoint {
    base::Vec3d position;
    base::Vec3d across{0, 0, 0}, down{0, 0, 0};
};

// What the pixel whose ray runs along `through` (of the plane) sees at `point`, where the plane that touches it has
// this normal: its edges to first order in the pixel.
CameraPoint camera_point(const rays::ImagePlane& plane, const base::Vec3d& through, const base::Vec3d& point,
                         const base::Vec3d& normal);

// Which of the surfaces that a view ray meets (as Tracer::surfaces has them, at least one) is drawn for u in [0, 1):
// each with the probability of its share of what is seen of all of them. That is the transmittance in front of it times
// its own opacity, the mean of the channels; in front of it are surfaces and, in `segments` (as Tracer::all_segments
// has them, or none), media. The draw inverts the cumulative share in order of depth: as the surfaces grow more opaque
// together, what is drawn for one u only comes nearer. Where less is seen than a double holds, the nearest.
std::size_t draw_surface(const std::vector<rays::SurfaceHit>& surfaces,
                         const std::vector<rays::TracedSegment>& segments, double u);

// For each pixel of the image, `media_lookups` places spread evenly over the media that its view ray passes before the
// first surface behind which nothing is left, then the place on one of the surfaces that the ray meets, drawn with one
// random number of the receivers' seed and the pixel: a pixel whose ray meets any surface of opacity above 0 has such a
// place, whatever the opacities. All at mid-shutter. `tracer` sees all objects.
std::vector<CameraPoint> camera_points(const scene::Receivers& receivers, const rays::Tracer& tracer);

}  // namespace shadowbench::bench
