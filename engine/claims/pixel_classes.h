// The vertices that techniques store, for the pixels of a class and for the others.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "scene/scenario.h"

namespace shadowbench::claims {

// Of each pixel of a scenario's first light, row after row, whether any of its rays meets anything that casts shadows.
std::vector<char> crossed_pixels(const nlohmann::json& document, const scene::SearchPath& data);

// The mean number of vertices of a pixel's function. 0 for a class without pixels.
struct MeanVertices {
    double all = 0.0, chosen = 0.0, others = 0.0;
};

// For each technique of the scenario, in the map of its first light. `chosen` has a value for each pixel. Techniques
// may not ask for rays around a tile. Memory holds the rays of a few tiles at a time.
std::vector<MeanVertices> mean_vertices(const nlohmann::json& document, const scene::SearchPath& data,
                                        const std::vector<char>& chosen);

}  // namespace shadowbench::claims
