// Handles densities below 0, for all readers of grids.
#pragma once

#include <string>
#include <vector>

#include "scene/read_notes.h"

namespace shadowbench::scene {

// Sets each density below 0 to 0, and adds a line to the notes if there was one.
void clamp_negatives(std::vector<float>& density, ReadNotes& notes);

// The message of a reader that refuses densities below 0.
std::string negative_refused(float density);

}  // namespace shadowbench::scene
