// What a .vdb file claims, held against its bytes before OpenVDB reads it: the library trusts the counts and sizes in a
// file, takes memory for them and does not look whether its reads succeed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/readers/choose_grid.h"

namespace shadowbench::scene {

struct VdbGrid : VdbGridName {
    std::string library_name;              // for File::readGrid
    std::vector<std::string> passed_over;  // the file's other grids, as people read them
};

// Walks over all of the headers and over the nodes of the grid that is meant, which it returns. Throws Error:
// no_such_file, io, what choose_grid throws, or bad_input with "file:offset" of what is damaged, cut short or of a kind
// that is not read.
VdbGrid check_vdb(const std::filesystem::path& file, const GridChoice& choice);

}  // namespace shadowbench::scene
