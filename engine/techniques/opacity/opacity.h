// Opacity shadow maps: Kim and Neumann, Opacity Shadow Maps, 2001, as Salvi et al. 2010 compare them.
#pragma once

#include "techniques/technique.h"

namespace shadowbench::techniques {

Technique opacity();

}  // namespace shadowbench::techniques
