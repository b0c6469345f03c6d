// Handles densities below 0, for all readers of grids.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/read_notes.h"
#include "scene/readers/files.h"

namespace shadowbench::scene {

// Sets each density below 0 to 0, and adds a line to the notes if there was one.
void clamp_negatives(std::vector<float>& density, ReadNotes& notes);

// Checks densities that no byte of the file stands for: throws Error{bad_input}, place the file, if one is not finite
// or is beyond max_coordinate, or is below 0 and that is refused. Else does the same as clamp_negatives().
void check_densities(GridVolume& volume, Negative negative, const std::filesystem::path& file);

// The message of a reader that refuses densities below 0.
std::string negative_refused(float density);

}  // namespace shadowbench::scene
