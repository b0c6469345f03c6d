// Depths as whole numbers of 16 bits, as Williams stored them: Casting Curved Shadows on Curved Surfaces, 1978.
#pragma once

#include <algorithm>
#include <cmath>

namespace shadowbench::claims {

// The depth that the nearest of 65,536 equal steps from z_min to z_max stands for.
inline float in_sixteen_bits(float z, float z_min, float z_max) {
    constexpr double steps = 65535.0;
    const double range = static_cast<double>(z_max) - z_min;
    const double step = std::clamp(std::round((static_cast<double>(z) - z_min) / range * steps), 0.0, steps);
    return static_cast<float>(z_min + step / steps * range);
}

}  // namespace shadowbench::claims
