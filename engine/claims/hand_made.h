// Lookups in a map of light rays that are given instead of captured.
#pragma once

#include <span>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "rays/light_rays.h"
#include "techniques/technique.h"

namespace shadowbench::claims {

// The answers from the technique's map of one tile, which is the whole map: one ray a pixel, depths from 0 to z_max.
std::vector<float> look_up(const char* technique, const nlohmann::json& parameters, const rays::LightRays& tile,
                           float z_max, std::span<const techniques::Query> queries);

}  // namespace shadowbench::claims
