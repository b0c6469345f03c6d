// Mip-maps of a deep shadow map (Lokovic and Veach 2000, section 5.3).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "techniques/deep/deep_level.h"
#include "techniques/deep/pixel_run.h"

namespace shadowbench::techniques {

// A pixel of level l covers 2^l by 2^l pixels of the map, fewer at the right and bottom edges if the map's size is not
// a power of two. Its function is the mean of the stored functions of the four pixels (or two, or one) of level l - 1
// that it covers, weighted by how many map pixels each covers, compressed within epsilon / 2^l; level 0 was compressed
// within epsilon.
//
// So the error e_l against the mean of the uncompressed functions of the map pixels covered is at most
//     e_0 <= epsilon,  e_l <= (weighted mean of the four e_(l-1)) + epsilon / 2^l,
// hence e_l <= epsilon (1 + 1/2 + ... + 1/2^l) = epsilon (2 - 2^-l) < 2 epsilon, up to the rounding of floats.
// Made of the uncompressed functions instead, a level errs by at most epsilon / 2^l and what drawing exponentials as
// lines takes.

// The number of levels of a map down to a single pixel, including the map.
int mip_levels(int width, int height);

// The side of a level, in its pixels, for a map side of `size` pixels.
inline int mip_size(int size, int level) {
    return static_cast<int>((static_cast<long long>(size) + (1LL << level) - 1) >> level);
}

// Appends all coarser levels to a map's level 0, which this compression made. `uncompressed` is level 0 before it was
// compressed: then coarser levels are made of it instead. Returns the most bytes held while building one level, apart
// from the levels.
std::size_t add_mip_levels(std::vector<DeepLevel>& levels, const Compression& compression,
                           std::optional<DeepLevel> uncompressed = {});

}  // namespace shadowbench::techniques
