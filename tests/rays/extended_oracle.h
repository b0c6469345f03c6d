// A second oracle, for tests only: transmittance in extended precision as the exponential of a sum of logarithms. It
// shares nothing with the engine except the arrays of LightRays, so the two cannot be wrong in the same way.
#pragma once

#include <cfloat>
#include <cmath>
#include <cstddef>

#include "rays/light_rays.h"

namespace shadowbench::rays::testing {

static_assert(LDBL_MANT_DIG >= 64, "the oracle must be finer than double");

// The side of a depth: a surface shades what is behind it, but not its own depth.
enum class Side { front, behind };

// -log(through). Next to 1 the distance from 1 is exact in long double, and log1p keeps its digits.
inline long double depth_of(float through) {
    const long double t = through;
    if (t <= 0.0L) return HUGE_VALL;
    return t > 0.5L ? -log1pl(t - 1.0L) : -logl(t);
}

// The optical depth that a segment puts in front of z. A medium darker than the smallest normal float counts as that
// float inside, and as its own transmittance only behind it.
inline long double depth_in_front(float z_front, float z_back, float through, long double z, Side side) {
    const bool step = z_front == z_back && side == Side::behind;
    if (step ? z < z_front : z <= z_front) return 0.0L;
    if (z >= z_back) return depth_of(through);
    const long double thickness = depth_of(through < FLT_MIN ? FLT_MIN : through);
    return thickness * (z - z_front) / (static_cast<long double>(z_back) - z_front);
}

// The same for the segments [begin, end), summed by halves: the error grows with the logarithm of their number.
inline long double depth_in_front(const LightRays& rays, std::size_t begin, std::size_t end, int channel, long double z,
                                  Side side) {
    if (end - begin > 8) {
        const std::size_t middle = begin + (end - begin) / 2;
        return depth_in_front(rays, begin, middle, channel, z, side) +
               depth_in_front(rays, middle, end, channel, z, side);
    }
    long double sum = 0.0L;
    for (std::size_t s = begin; s < end; ++s) {
        const float z_front = rays.z_front[s], z_back = rays.z_back.empty() ? z_front : rays.z_back[s];
        const std::size_t value = s * static_cast<std::size_t>(rays.channels) + static_cast<std::size_t>(channel);
        sum += depth_in_front(z_front, z_back, rays.transmittance[value], z, side);
    }
    return sum;
}

// The transmittance of one ray up to z. Relative error below 2^-62 (1 + optical depth) log2(segments).
inline long double extended_transmittance(const LightRays& rays, std::size_t ray, int channel, long double z,
                                          Side side = Side::front) {
    return expl(-depth_in_front(rays, rays.begin[ray], rays.begin[ray + 1], channel, z, side));
}

// The mean over the rays [first, first + count): the visibility of a pixel.
inline long double extended_visibility(const LightRays& rays, std::size_t first, std::size_t count, int channel,
                                       long double z, Side side = Side::front) {
    long double sum = 0.0L;
    for (std::size_t ray = first; ray < first + count; ++ray)
        sum += extended_transmittance(rays, ray, channel, z, side);
    return sum / static_cast<long double>(count);
}

}  // namespace shadowbench::rays::testing
