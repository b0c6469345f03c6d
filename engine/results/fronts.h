#pragma once

#include <span>

#include "results/result.h"

namespace shadowbench::results {

// Marks the cells that no other cell of the same light beats: lookup time (random order) against lookup error (RMS),
// and bytes against lookup error. Failed cells are on no front.
void mark_fronts(std::span<Cell> cells);

}  // namespace shadowbench::results
