// Shows errors as colours that can be read back: a perceptually uniform colour map with its numbers below the picture.
#pragma once

#include <span>

#include "render/image.h"

namespace shadowbench::render {

// The smallest of 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1 that is at least `error`; 1 beyond.
double legend_top(double error);

// Takes one value a pixel, row after row. Values from 0 to `top` run through the colour map "viridis" (Smith and van
// der Walt, matplotlib 1.5); larger values have its last colour. Below the picture are the colour map as a bar and the
// numbers 0, top / 2 and top, if the picture is wide enough. Colours are linear, so that a display shows the published
// ones.
Image heat_map(std::span<const float> values, int width, int height, double top);

// Number of rows that the legend adds.
int legend_height();

}  // namespace shadowbench::render
