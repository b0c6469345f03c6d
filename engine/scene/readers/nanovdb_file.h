// The grids of a .nvdb file (NanoVDB's util/IO.h, major version 32 of the format): segments of a header, the facts of
// each grid, and the grids' bytes, packed or not.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/readers/choose_grid.h"
#include "scene/readers/file_reader.h"

namespace shadowbench::scene {

struct NanoVdbGrid {
    // Structures of NanoVDB lie at multiples of 32 bytes.
    struct alignas(32) Block {
        std::array<std::byte, 32> bytes;
    };

    VdbGridName name;
    std::vector<std::string> passed_over;  // the file's other grids, as shown to people
    std::uint64_t begin = 0;               // the byte of the file at which the grid begins
    std::uint64_t size = 0;                // bytes of the grid
    std::vector<Block> blocks;             // hold them
};

// The grid that the choice names. Throws Error: the errors of choose_grid, or bad_input, also if the grid has more than
// `most_bytes`.
NanoVdbGrid read_nanovdb_grid(FileReader& file, const std::filesystem::path& name, const GridChoice& choice,
                              std::uint64_t most_bytes);

}  // namespace shadowbench::scene
