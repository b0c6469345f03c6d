// Checks what a .vdb file claims against its bytes before OpenVDB reads it: the library trusts the counts and sizes in
// a file, allocates memory for them and does not check whether its reads succeed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/readers/choose_grid.h"

namespace shadowbench::scene {

struct VdbGrid : VdbGridName {
    std::vector<std::string> passed_over;                // the file's other grids, as shown to people
    std::uint32_t format = 0;                            // version of the file
    std::uint32_t library_major = 0, library_minor = 0;  // that wrote it
    std::uint64_t begin = 0, tree_begin = 0;             // the bytes at which it and the grid whose tree it has begin
    bool half = false;                                   // that tree's values are float16
};

// Walks over all headers and over the nodes of the chosen grid, which it returns. Throws Error: no_such_file, io, the
// errors of choose_grid, or bad_input with the byte of data that is damaged, cut short or of an unsupported kind.
VdbGrid check_vdb(const std::filesystem::path& file, const GridChoice& choice);

}  // namespace shadowbench::scene
