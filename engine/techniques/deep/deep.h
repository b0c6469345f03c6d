// Deep shadow maps: Lokovic and Veach, Deep Shadow Maps, 2000.
#pragma once

#include <span>

#include "techniques/deep/deep_level.h"
#include "techniques/technique.h"

namespace shadowbench::techniques {

Technique deep();

// What a finished deep shadow map holds, level 0 and then its mip levels; nothing of a map of another technique.
std::span<const DeepLevel> levels(const Map& map);

}  // namespace shadowbench::techniques
