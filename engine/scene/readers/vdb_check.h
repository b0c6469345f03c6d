// Checks what a .vdb file claims against its bytes before OpenVDB reads it: the library trusts the counts and sizes in
// a file, allocates memory for them and does not check whether its reads succeed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/readers/choose_grid.h"

namespace shadowbench::scene {

struct VdbGrid : VdbGridName {
    std::string library_name;              // for File::readGrid
    std::vector<std::string> passed_over;  // the file's other grids, as shown to people
};

// Walks over all headers and over the nodes of the chosen grid, which it returns. Throws Error: no_such_file, io, the
// errors of choose_grid, or bad_input with the byte of data that is damaged, cut short or of an unsupported kind.
VdbGrid check_vdb(const std::filesystem::path& file, const GridChoice& choice);

}  // namespace shadowbench::scene
