// Marks the cells on the fronts of time against error and of bytes against error.
#pragma once

#include <span>

#include "results/result.h"

namespace shadowbench::results {

// Marks the cells of one light that no other cell beats: in lookup time (random order) and lookup error (RMS), and in
// bytes and lookup error. Failed cells are on no front.
void mark_fronts(std::span<Cell> cells);

}  // namespace shadowbench::results
