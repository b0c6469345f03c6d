// Deep shadow maps: Lokovic and Veach, Deep Shadow Maps, 2000.
#pragma once

#include <span>

#include "techniques/deep/deep_level.h"
#include "techniques/technique.h"

namespace shadowbench::techniques {

Technique deep();

// The level 0 and mip levels of a finished deep shadow map; nothing for a map of another technique.
std::span<const DeepLevel> levels(const Map& map);

}  // namespace shadowbench::techniques
