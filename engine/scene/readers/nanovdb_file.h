// The grids of a .nvdb file (NanoVDB's util/IO.h, major version 32 of the format): segments of a header, the facts of
// each grid, and the grids' bytes, packed or not.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/readers/choose_grid.h"
#include "scene/readers/file_reader.h"

namespace shadowbench::scene {

enum class NanoVdbCodec : std::uint16_t { none, zip, blosc };

struct NanoVdbGrid {
    VdbGridName name;
    std::vector<std::string> passed_over;  // the file's other grids, as shown to people
    NanoVdbCodec codec = NanoVdbCodec::none;
    std::uint64_t begin = 0;          // the byte of the file at which the grid begins, packed or not
    std::uint64_t bytes_in_file = 0;  // from there on
    std::uint64_t size = 0;           // bytes of the grid, unpacked; nanovdb_bytes.h reads them
};

// The grid that the choice names. Throws Error: the errors of choose_grid, or bad_input, also if the grid has more than
// `most_bytes`, or more than its bytes in the file can hold.
NanoVdbGrid find_nanovdb_grid(FileReader& file, const std::filesystem::path& name, const GridChoice& choice,
                              std::uint64_t most_bytes);

}  // namespace shadowbench::scene
