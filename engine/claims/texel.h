// The functions that techniques store for one texel, with the uncompressed one, as papers plot them.
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
    std::vector<Series> series;  // one per technique of the document, in order; then the uncompressed function
    std::vector<double> error;   // largest distance of each series from the uncompressed function
};

// Takes the first light of a scenario with one ray a pixel. Chooses the texel whose ray crosses the most segments among
// those whose light is not gone by half their depth.
TexelCurves busiest_texel(const nlohmann::json& document, const scene::SearchPath& data);

}  // namespace shadowbench::claims
