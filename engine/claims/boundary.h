// Boundaries of shadows in a picture.
#pragma once

#include <span>

#include "base/vec.h"

namespace shadowbench::claims {

enum class Shade : unsigned char { unseen, lit, shadowed };

// The length in pixels of the boundaries between lit and shadowed pixels of a picture of this size, row after row. They
// are crossed by pi / 4 pixels of length for each two neighbours, across or down, that differ: exact in the mean over
// all directions (Crofton's formula). Unseen pixels have no boundaries.
double boundary_length(std::span<const Shade> pixels, base::Vec2i size);

}  // namespace shadowbench::claims
