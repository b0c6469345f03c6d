// Receivers -> queries: the places of one light's map where visibility is asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "rays/light_view.h"
#include "rays/tracer.h"
#include "scene/scene.h"
#include "techniques/technique.h"

namespace shadowbench::bench {

struct QuerySet {
    std::vector<techniques::Query> queries;  // in image order: row after row, each view ray from its front to its back
    std::uint64_t dropped = 0;               // receivers outside the light's map
};

// World points: for each pixel of the image, `media_lookups` places spread evenly over the media that its view ray
// passes before the nearest surface, then the place on that surface, at mid-shutter. `tracer` sees all objects.
std::vector<base::Vec3d> camera_points(const scene::Receivers& receivers, const rays::Tracer& tracer);

// The points as queries of one light, moved towards it by the bias.
QuerySet queries_of_points(const std::vector<base::Vec3d>& points, const scene::Receivers& receivers,
                           const rays::LightView& view);

// Points spread evenly over the map and over the depths of what casts shadows, with a little behind it.
QuerySet probe_queries(const scene::Receivers& receivers, const rays::LightView& view);

// Indices of `count` queries out of `total`, one in each of `count` equal stretches; all of them when there are fewer.
std::vector<std::size_t> choose_judged(std::size_t total, std::size_t count, std::uint64_t seed);

}  // namespace shadowbench::bench
