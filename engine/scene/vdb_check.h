// What a .vdb file claims, held against its bytes before OpenVDB reads it: the library trusts the counts and sizes in a
// file, takes memory for them and does not look whether its reads succeed.
#pragma once

#include <filesystem>
#include <string>

namespace shadowbench::scene {

// Walks over all of the headers and over the nodes of the float grids called `grid`. Throws Error: no_such_file, io, or
// bad_input with "file:offset" of what is damaged, cut short or of a kind that is not read. Returns the names of the
// grids, joined by ", ".
std::string check_vdb(const std::filesystem::path& file, const std::string& grid);

}  // namespace shadowbench::scene
