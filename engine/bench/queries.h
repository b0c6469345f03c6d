// Receivers -> queries: the places of one light's map where visibility is asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/maps.h"
#include "rays/image_plane.h"
#include "rays/light_view.h"
#include "rays/tracer.h"
#include "scene/scene.h"
#include "techniques/technique.h"

namespace shadowbench::bench {

struct QuerySet {
    std::vector<techniques::Query> queries;  // in image order: row after row, each view ray from its front to its back
    std::vector<techniques::Footprint> footprints;  // of the camera's pixels, one a query; none without a camera
    std::uint64_t dropped = 0;                      // receivers outside the light's map

    Asked asked() const { return {queries, footprints}; }
};

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

// For each pixel of the image, `media_lookups` places spread evenly over the media that its view ray passes before the
// nearest surface, then the place on that surface, all at mid-shutter. `tracer` sees all objects.
std::vector<CameraPoint> camera_points(const scene::Receivers& receivers, const rays::Tracer& tracer);

// A world point as a query of one light, moved towards it by the bias; nothing when it is outside the light's map.
std::optional<techniques::Query> query_of_point(const base::Vec3d& point, const scene::Receivers& receivers,
                                                const rays::LightView& view);

// The pixel of a point as it lies in the light's map.
techniques::Footprint footprint_of(const CameraPoint& point, const rays::LightView& view);

// All points as queries, in their order, and their pixels as they lie in the map: the edges under the derivative of the
// projection at the point.
QuerySet queries_of_points(std::span<const CameraPoint> points, const scene::Receivers& receivers,
                           const rays::LightView& view);

// The receivers' given points as queries, in their order; without footprints.
QuerySet point_queries(const scene::Receivers& receivers, const rays::LightView& view);

// Points spread evenly over the map and over the depths of what casts shadows, with a little behind it.
QuerySet probe_queries(const scene::Receivers& receivers, const rays::LightView& view);

// Indices of `count` queries out of `total`, one in each of `count` equal stretches; all of them when there are fewer.
std::vector<std::size_t> choose_judged(std::size_t total, std::size_t count, std::uint64_t seed);

// Those of what is asked.
QuerySet pick(const Asked& asked, std::span<const std::size_t> indices);

}  // namespace shadowbench::bench
