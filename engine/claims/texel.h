// The functions that techniques store for single texels, with the uncompressed ones, as papers plot them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "claims/paper.h"
#include "curves/curve.h"
#include "rays/light_rays.h"
#include "scene/scenario.h"

namespace shadowbench::claims {

struct TexelCurves {
    int x = 0, y = 0;                   // the texel
    std::uint64_t segments = 0;         // of its ray
    std::vector<Series> series;         // one per technique of the document, in order; then the uncompressed function
    std::vector<double> error;          // largest distance of each series from the uncompressed function
    std::vector<curves::Curve> stored;  // the functions of the series
};

// What a paper says of the ray whose curve it shows.
struct RayWish {
    int nodes = 0;  // of its uncompressed function, two a segment; 0: as many as there are
    bool (*fits)(const rays::LightRays& tile, std::size_t ray, const rays::MapLayout& layout) = nullptr;
};

// Whether more than 0.3 of the light is left at half the depth range: a dark ray shows nothing of its deeper nodes.
bool lit_at_half_depth(const rays::LightRays& tile, std::size_t ray, const rays::MapLayout& layout);

struct RayPlace {
    std::size_t tile = 0, ray = 0;
};

// The `count` rays that fit and whose numbers of nodes are nearest to the wish, the nearest first. Any two are more
// than a 32nd of the map apart, so that they cross different occluders. One ray a pixel. Throws Error{internal} if too
// few rays fit.
std::vector<RayPlace> choose_rays(const std::vector<rays::LightRays>& tiles, const rays::MapLayout& layout,
                                  const RayWish& wish, std::size_t count);

struct Texels {
    results::LightResult light;  // its cells are the techniques of the document, with the bytes of their whole maps
    std::vector<TexelCurves> curves;

    // The place of a technique in the series, found as cell_of() does.
    std::size_t series(const std::string& technique, const std::vector<std::string>& parameters = {}) const;
};

// The functions of the texels of these rays, for the first light of a scenario with one ray a pixel.
Texels texel_curves(const nlohmann::json& document, const scene::SearchPath& data, const RayWish& wish,
                    std::size_t count);

// The texel whose ray crosses the most segments among those that are lit at half their depth.
TexelCurves busiest_texel(const nlohmann::json& document, const scene::SearchPath& data);

}  // namespace shadowbench::claims
