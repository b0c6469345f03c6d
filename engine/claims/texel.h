// The functions that techniques store for one texel, beside the uncompressed one: what papers plot.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "claims/claim.h"
#include "scene/scenario.h"

namespace shadowbench::claims {

struct TexelCurves {
    int x = 0, y = 0;            // the texel
    std::uint64_t segments = 0;  // of its ray
    std::vector<Series> series;  // one a technique of the document, in order; then the uncompressed function
    std::vector<double> error;   // of each series, largest distance from the uncompressed function
};

// Of the first light of a scenario of one ray a pixel: the texel whose ray crosses the most segments among those whose
// light is not gone by half their depth.
TexelCurves busiest_texel(const nlohmann::json& document, const scene::SearchPath& data);

}  // namespace shadowbench::claims
