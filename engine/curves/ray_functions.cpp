#include "curves/ray_functions.h"

#include "curves/sweep_surfaces.h"
#include "rays/light_rays.h"

namespace shadowbench::curves {

RayFunctions::RayFunctions(const rays::LightRays& tile) {
    const auto samples = static_cast<std::size_t>(tile.samples);
    begin_.reserve(tile.rays() + 1);
    begin_.push_back(0);
    nodes_.reserve(2 * tile.segments());
    for (std::size_t first = 0; first < tile.rays(); first += samples) {
        const bool media = !surfaces_only(tile, first, samples);
        for (std::size_t ray = first; ray < first + samples; ++ray) {
            if (media) {
                composite(tile, ray, 0, open_, ray_);
                nodes_.insert(nodes_.end(), ray_.begin(), ray_.end());
            }
            begin_.push_back(nodes_.size());
        }
    }
}

}  // namespace shadowbench::curves
