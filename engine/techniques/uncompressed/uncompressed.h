// Every captured segment, kept and evaluated exactly: the reference of Salvi et al. 2010, and the truth of the rays.
#pragma once

#include "techniques/technique.h"

namespace shadowbench::techniques {

Technique uncompressed();

}  // namespace shadowbench::techniques
