// The points that a camera sees as queries to the map of a light, and their answers as light in a picture.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "rays/light_view.h"
#include "render/shading_points.h"
#include "scene/scenario.h"
#include "techniques/technique.h"

namespace shadowbench::render {

// The shading points inside a light's map, in their order.
struct PointQueries {
    std::vector<techniques::Query> queries;
    std::vector<techniques::Footprint> footprints;
    std::vector<std::uint32_t> point;  // index of each query's point
};
PointQueries point_queries(const ShadingPoints& points, const scene::Receivers& receivers, const rays::LightView& view,
                           const std::optional<scene::FilterWidth>& softness = {});

// Adds a light to a picture. answers[c * queries + q] is that of query q in channel c, cut to [0, 1]; points without an
// answer are lit.
template <class Answers>
void add_answers(const ShadingPoints& points, std::size_t light, const PointQueries& asked, const Answers& answers,
                 Picture& picture) {
    const std::size_t count = points.points(), queries = asked.queries.size();
    const std::size_t channels = queries ? answers.size() / queries : 1;
    std::vector<float> visibility(count * channels, 1.0f);
    for (std::size_t c = 0; c < channels; ++c)
        for (std::size_t q = 0; q < queries; ++q)
            visibility[c * count + asked.point[q]] =
                std::clamp(static_cast<float>(answers[c * queries + q]), 0.0f, 1.0f);
    add_light(points, light, visibility, picture);
}

}  // namespace shadowbench::render
