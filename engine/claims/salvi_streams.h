// Segments of light rays in other orders than that of depth, and curves that grow segment by segment: what the
// experiments on streaming of Salvi et al. 2010 are made of.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "curves/curve.h"
#include "rays/light_rays.h"

namespace shadowbench::claims::salvi {

// The same tiles with the segments of each ray submitted in another order: each stretch of `window` successive ones is
// shuffled. The tiles must hold their orders of submission.
std::vector<rays::LightRays> shuffled(const std::vector<rays::LightRays>& tiles, std::uint32_t window,
                                      std::uint64_t seed);

struct Segment {
    float front, back, through;
};

// Copies the segments of a ray to `out` in their order of submission and sorts the copy by front, by insertion as the
// paper does. Returns how often a segment moved.
std::uint64_t insertion_sort(const rays::LightRays& tile, std::size_t ray, std::vector<Segment>& out);

// A tile of one ray that holds these segments of another tile, submitted in this order. Their numbers in that tile are
// in order of depth.
rays::LightRays one_ray(const rays::LightRays& tile, std::span<const std::uint32_t> order);

// The curve with one more medium, front < back: exact at its vertices and at the ends of the medium, and linear between
// them.
curves::Curve with_medium(curves::Curve curve, const Segment& medium);

}  // namespace shadowbench::claims::salvi
