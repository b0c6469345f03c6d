// Fourier opacity maps: Jansen and Bavoil, Fourier Opacity Mapping, 2010.
#pragma once

#include "techniques/technique.h"

namespace shadowbench::techniques {

Technique fourier();

}  // namespace shadowbench::techniques
