// What the readers of grids share: densities below 0.
#pragma once

#include <string>
#include <vector>

#include "scene/read_notes.h"

namespace shadowbench::scene {

// Takes each density below 0 as 0; adds a line to the notes when there was one.
void clamp_negatives(std::vector<float>& density, ReadNotes& notes);

// The message for those who asked for a refusal.
std::string negative_refused(float density);

}  // namespace shadowbench::scene
