// Reads a grid of a .vdb or .nvdb file together with what its densities do not show.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "scene/limits.h"
#include "scene/readers/files.h"

namespace shadowbench::scene {

struct VdbFacts {
    std::string grid;          // its name, as shown to people
    std::uint64_t active = 0;  // voxels
    std::string axes;          // the world's directions of the grid's x, y and z: text_of() of place_grid.h
};

// As the functions of files.h; they set `facts`.
GridVolume read_vdb(const std::filesystem::path& file, const GridChoice& grid, Negative negative,
                    std::uint64_t most_voxels, VdbFacts& facts);
GridVolume read_nanovdb(const std::filesystem::path& file, const GridChoice& grid, Negative negative,
                        std::uint64_t most_voxels, VdbFacts& facts);

}  // namespace shadowbench::scene
