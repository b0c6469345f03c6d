// The size and the antialiasing of pictures for the eye.
#pragma once

#include "base/vec.h"

namespace shadowbench::render {

inline constexpr int usual_width = 512, usual_rays_per_side = 2, usual_media_lookups = 64;
inline constexpr double most_enlarged = 8.0;

// The size in the same proportions that is `usual_width` wide, unless it is then more than twice as high, or more than
// `most_enlarged` times `size`, which a scenario chose to be quick: the largest that is neither. `size` if that is
// larger.
base::Vec2i enlarged(base::Vec2i size);

}  // namespace shadowbench::render
