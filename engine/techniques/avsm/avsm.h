// Adaptive volumetric shadow maps: Salvi, Vidimce, Lauritzen, Lefohn, Adaptive Volumetric Shadow Maps, 2010.
#pragma once

#include "techniques/technique.h"

namespace shadowbench::techniques {

Technique avsm();

}  // namespace shadowbench::techniques
