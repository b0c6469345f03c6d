// Deep shadow maps from volumetric data: the depths at which a ray has lost 10, 50 and 90 % of its light, and how much
// it loses in all.
#pragma once

#include "techniques/technique.h"

namespace shadowbench::techniques {

Technique volume_deep();

}  // namespace shadowbench::techniques
