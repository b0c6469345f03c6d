// Deep shadow maps from volumetric data: how far the depths that a map stores are from those at which light rays truly
// lose 10, 50 and 90 % of their light.
#pragma once

#include <span>
#include <vector>

#include "bench/maps.h"
#include "claims/volume.h"
#include "rays/light_rays.h"
#include "rays/light_view.h"
#include "scene/scene.h"

namespace shadowbench::claims::volume {

// The light ray of a texel, and what a map without steps would store of it. Depths are of the levels that it reaches.
struct TexelRay {
    int x = 0, y = 0;
    Channels exact;
};

// Of texels spread over a map with this layout, which has one ray a texel.
std::vector<TexelRay> texel_rays(const scene::Scene& scene, const rays::LightView& view, const rays::MapLayout& layout);

// The mean distance of the depths that the map stores from the exact ones, over all levels that the rays reach, in
// steps of which the map has so many. (Not the rms: a ray that all but loses a level in front of a gap would rule it.)
double depth_error(const bench::Maps& maps, std::span<const TexelRay> texels, int steps);

}  // namespace shadowbench::claims::volume
