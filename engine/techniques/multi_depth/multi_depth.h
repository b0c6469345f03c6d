// Several depths a cell and a test with several outcomes: Pagot, Comba, Oliveira, Multiple-Depth Shadow Maps, 2004.
#pragma once

#include "techniques/technique.h"

namespace shadowbench::techniques {

Technique multi_depth();

}  // namespace shadowbench::techniques
