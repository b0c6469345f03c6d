// Deep shadow maps: Lokovic and Veach, Deep Shadow Maps, 2000.
#pragma once

#include <optional>
#include <span>

#include "techniques/deep/deep_level.h"
#include "techniques/deep/tiled_map.h"
#include "techniques/technique.h"

namespace shadowbench::techniques {

Technique deep();

// The level 0 and mip levels of a finished deep shadow map; nothing for a map in tiles or of another technique.
std::span<const DeepLevel> levels(const Map& map);

// What happened to the tiles of a deep shadow map with storage=tiled; nothing for another map.
std::optional<TileCounts> tiles(const Map& map);

}  // namespace shadowbench::techniques
