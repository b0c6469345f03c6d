// No map: shadow rays through the scene for every lookup. The cost and quality without any of the techniques.
#pragma once

#include "techniques/technique.h"

namespace shadowbench::techniques {

Technique ray_traced();

}  // namespace shadowbench::techniques
