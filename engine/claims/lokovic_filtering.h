// The parts of filtering(): figure 9, section 5.3 and section 5.4 of Lokovic and Veach, Deep Shadow Maps, 2000.
#pragma once

#include "claims/paper.h"

namespace shadowbench::claims::lokovic {

void widths(const Context& context);      // figure 9: times over filter widths
void levels(const Context& context);      // section 5.3: the size of mip levels
void blends(const Context& context);      // section 5.3: the error of mip levels over filter widths
void footprints(const Context& context);  // section 5.3: anisotropic filters
void tiles(const Context& context);       // section 5.4

// The seeds of the light rays over which sizes and errors are measured.
inline constexpr int ray_seeds = 3;

}  // namespace shadowbench::claims::lokovic
