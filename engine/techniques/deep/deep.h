// Deep shadow maps: Lokovic and Veach, Deep Shadow Maps, 2000.
#pragma once

#include "techniques/technique.h"

namespace shadowbench::techniques {

Technique deep();

}  // namespace shadowbench::techniques
