// Colours for values.
#pragma once

#include <vector>

#include "base/vec.h"

namespace shadowbench::render {

// The colour map "viridis" (Smith and van der Walt, matplotlib 1.5) of width * height values in [0, 1], row after row.
// Colours are linear, so that a display shows the published ones.
std::vector<base::Vec3f> colour_map(const std::vector<float>& values, int width, int height);

}  // namespace shadowbench::render
