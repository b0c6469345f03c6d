// The header of a DDS file: how its values lie.
#pragma once

#include <array>
#include <cstdint>

#include "scene/readers/file_reader.h"
#include "scene/scene.h"

namespace shadowbench::scene {

struct DdsLayout {
    Vec3i size{0, 0, 0};
    std::uint64_t begin = 0;                  // byte of the first slice
    bool blocks = false;                      // BC2 or BC3; else texels one after the other
    bool bc2 = false;                         // with blocks: BC2
    int texel_bytes = 0;                      // without blocks
    std::array<int, 4> byte{-1, -1, -1, -1};  // without blocks: red, green, blue and alpha in a texel; -1: none
    int mip_levels = 1;
};

// Reads the header of a volume texture. Throws Error{bad_input} for other textures, formats other than BC2, BC3 and
// 8 bits a channel, and more than `most_voxels`.
DdsLayout read_dds_layout(FileReader& file, std::uint64_t most_voxels);

}  // namespace shadowbench::scene
