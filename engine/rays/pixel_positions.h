// The map positions of all rays of a pixel, many times as fast as one by one where the layout is multi-jittered.
#pragma once

#include <vector>

#include "rays/light_rays.h"

namespace shadowbench::rays {

// Sets `positions` to those of the rays of pixel (x, y): sample_position() of its cells, row after row.
void pixel_positions(const MapLayout& layout, int x, int y, std::vector<SamplePosition>& positions);

}  // namespace shadowbench::rays
