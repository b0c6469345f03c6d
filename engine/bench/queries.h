// Turns receivers into queries: places of one light's map at which visibility is looked up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/camera_points.h"
#include "bench/maps.h"
#include "rays/light_view.h"
#include "scene/scene.h"
#include "techniques/technique.h"

namespace shadowbench::bench {

struct QuerySet {
    std::vector<techniques::Query> queries;  // in image order: row after row, each view ray from its front to its back
    std::vector<techniques::Footprint> footprints;  // of the camera's pixels, one per query; none without a camera
    std::uint64_t dropped = 0;                      // receivers outside the light's map

    Asked asked() const { return {queries, footprints}; }
};

// The pixel of a point, projected into the light's map.
techniques::Footprint footprint_of(const CameraPoint& point, const rays::LightView& view);

// A point as a query of one light, moved by the biases; absent if it is outside the light's map. Only widths in
// receiver pixels need the point's edges; where they are unbounded, the width is infinite. `softness`, the light's,
// stands for the receivers' width. The slope bias moves a point no farther than before all casters, where everything is
// lit.
std::optional<techniques::Query> query_of_point(const CameraPoint& point, const scene::Receivers& receivers,
                                                const rays::LightView& view,
                                                const std::optional<scene::FilterWidth>& softness = {});

// All points as queries, in their order, with their pixels projected into the map: the edges are mapped by the
// derivative of the projection at the point.
QuerySet queries_of_points(std::span<const CameraPoint> points, const scene::Receivers& receivers,
                           const rays::LightView& view, const std::optional<scene::FilterWidth>& softness = {});

// The receivers' given points as queries, in their order, without footprints.
QuerySet point_queries(const scene::Receivers& receivers, const rays::LightView& view,
                       const std::optional<scene::FilterWidth>& softness = {});

// Points spread evenly over the map (of a cube's face: without its border) and over the depth range of the casters, and
// a little behind it.
QuerySet probe_queries(const scene::Receivers& receivers, const rays::LightView& view,
                       const std::optional<scene::FilterWidth>& softness = {});

// The queries of a scenario's receivers to the light with this view; `seen`: what its camera sees, none without a
// camera. Throws Error{bad_input} if no receiver is inside the map.
QuerySet scenario_queries(const scene::Scenario& scenario, const scene::Light& light, std::span<const CameraPoint> seen,
                          const rays::LightView& view);

// Lookups that reach over the map of a face of a point light, so that a part of them is cut off at the seams of the
// cube. Those of unbounded width, which cover the whole map, do not count.
struct CutLookups {
    std::uint64_t count = 0;
    double border = 0.0;  // with which none of them would be cut
};
CutLookups cut_at_seams(std::span<const techniques::Query> queries, const rays::LightView& view);

// The queries that are compared with the truth.
QuerySet judged_queries(const scene::Scenario& scenario, const QuerySet& set);

// Asks the same question of another map of the same light that frames the same part of its plane: positions, widths and
// pixels keep their places and sizes in light space. Throws Error{internal} if the maps differ in more than their
// resolution.
QuerySet rescaled(const Asked& asked, const rays::LightView& from, const rays::LightView& to);

// Indices of `count` queries out of `total`, one from each of `count` equal stretches; all if there are fewer.
std::vector<std::size_t> choose_judged(std::size_t total, std::size_t count, std::uint64_t seed);

// The queries with these indices.
QuerySet pick(const Asked& asked, std::span<const std::size_t> indices);

}  // namespace shadowbench::bench
