// Errors as colours that can be read back: a perceptually uniform map with its numbers below the picture.
#pragma once

#include <span>

#include "render/image.h"

namespace shadowbench::render {

// The smallest of 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1 that is at least `error`; 1 beyond.
double legend_top(double error);

// One value a pixel, row after row; 0 to `top` run through the map "viridis" (Smith and van der Walt, matplotlib 1.5),
// larger ones stay at its end. Below stand the map as a bar and the numbers 0, top / 2 and top, when the picture is
// wide enough for them. The colours are linear, so that a display shows the map as it was made.
Image heat_map(std::span<const float> values, int width, int height, double top);

// Rows that the legend adds.
int legend_height();

}  // namespace shadowbench::render
