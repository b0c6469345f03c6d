// The rays of a pixel, averaged into one: so a technique that stores the function of one ray a texel can store the
// function of a pixel, filtered before it is stored.
#pragma once

#include <cstddef>

#include "curves/curve.h"
#include "curves/ray_functions.h"
#include "curves/sweep.h"
#include "rays/light_rays.h"

namespace shadowbench::techniques {

// One object a thread; its memory is used again from tile to tile.
class MeanRays {
public:
    // A tile of the same pixels with one ray each, whose transmittance at every depth is the mean of the pixel's rays.
    // Where rays only hit surfaces it is exact to the rounding of one float a segment. Where a pixel's mean changes
    // inside media, its segments have constant extinction; between the depths at which the rays change, the mean is
    // cut into so many segments that it errs by at most 1e-4. In submission order the segments are sorted by depth.
    // Valid until the next call. With `functions` of the tile's rays, they are not made again.
    const rays::LightRays& of(const rays::LightRays& tile, const curves::RayFunctions* functions = nullptr);
    const rays::LightRays& rays() const { return result_; }  // of the last call

    std::size_t bytes() const;

private:
    curves::SweepScratch scratch_;
    curves::Curve mean_;
    rays::LightRays result_;
    std::size_t functions_bytes_ = 0;  // of the scratch memory for the functions handed over
};

}  // namespace shadowbench::techniques
