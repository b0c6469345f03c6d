// Depth maps: the plain shadow map (Williams, Casting Curved Shadows on Curved Surfaces, 1978) and percentage closer
// filtering over it (Reeves, Salesin, Cook, Rendering Antialiased Shadows with Depth Maps, 1987).
#pragma once

#include "techniques/technique.h"

namespace shadowbench::techniques {

Technique shadow_map();
Technique pcf();

}  // namespace shadowbench::techniques
