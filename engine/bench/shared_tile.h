// A tile of light rays on its way into several maps.
#pragma once

#include <array>
#include <optional>

#include "bench/maps.h"
#include "curves/ray_functions.h"
#include "rays/light_rays.h"
#include "techniques/mean_rays.h"

namespace shadowbench::bench {

// What several maps make alike of a tile: its channels, the functions of its rays, and the means of its pixels. Each is
// made once, when the first map needs it. For one thread; the tile must outlive it.
class SharedTile {
public:
    explicit SharedTile(const rays::LightRays& rays) : rays_(rays) {}

    const rays::LightRays& rays() const { return rays_; }
    const rays::LightRays& channel(std::size_t c);
    const curves::RayFunctions& functions(std::size_t c);
    const techniques::MeanRays& means(std::size_t c);  // made of the functions, if the tile has them

private:
    const rays::LightRays& rays_;
    std::array<std::optional<rays::LightRays>, 3> channels_;
    std::array<std::optional<curves::RayFunctions>, 3> functions_;
    std::array<std::optional<techniques::MeanRays>, 3> means_;
};

// Whether maps with these needs share functions or means with others, at least of some tiles.
bool shares(const techniques::RayNeeds& needs, const rays::MapLayout& layout);
// Whether the maps are made of the means of this tile's pixels.
bool reads_means(const Maps& maps, const rays::LightRays& tile);
// Whether the maps, or the means they are made of, are made of the functions of this tile's rays.
bool reads_functions(const Maps& maps, const rays::LightRays& tile);

// Makes what part p of the maps reads of the tile, except functions and means.
void prepare_part(const Maps& maps, std::size_t p, SharedTile& tile);
// Adds the tile to part p of the maps, or to all parts. Thread-safe for different tiles.
void add_part(Maps& maps, std::size_t p, SharedTile& tile);
void add(Maps& maps, SharedTile& tile);

}  // namespace shadowbench::bench
