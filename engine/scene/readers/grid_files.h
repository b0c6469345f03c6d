// Readers of volumes that are read_voxels() behind a header; errors as in files.h. Densities are those of the file if
// its values are floating-point numbers; integers are divided by the largest of their type. The box is that of the
// file, or begins at the origin; the caller sets the step. Values may be packed by gzip or zlib. Axes may be swapped
// and mirrored, which is exact; turned otherwise, or sheared, the volume has a frame (place_grid.h). A volume of more
// than `most_voxels` is bad input.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/limits.h"
#include "scene/readers/files.h"
#include "scene/readers/voxel_values.h"

namespace shadowbench::scene {

struct GridFile {
    GridVolume volume;
    std::vector<std::string> facts;  // what the densities do not show, in lines for people
};

// Raw values without a header.
struct RawFormat {
    Vec3i size{0, 0, 0};
    ValueType type = ValueType::uint8;
    ByteOrder order = ByteOrder::little;
    std::uint64_t skip = 0;  // bytes in front of the values; unpacked ones
};

// Packed by gzip if its extension is .gz. The file must have exactly the values that the format needs. The caller sets
// the box too.
GridVolume read_raw_values(const std::filesystem::path& file, const RawFormat& format, Negative negative);

// NRRD 1 to 6 (teem.sourceforge.net/nrrd/format.html): .nrrd, or .nhdr with its values in another file. That file must
// lie in the folder of the header or below it. Of more than three axes, those of one value are left out. Values in text
// and several data files are bad input.
GridFile read_nrrd(const std::filesystem::path& file, Negative negative = Negative::clamp,
                   std::uint64_t most_voxels = max_voxels);

// MetaImage: .mha, or .mhd with its values in another file, which must lie as that of read_nrrd(). Values in text and
// several data files are bad input.
GridFile read_metaimage(const std::filesystem::path& file, Negative negative = Negative::clamp,
                        std::uint64_t most_voxels = max_voxels);

// Mitsuba's .vol, version 3: one channel of float32, float16 or uint8. The first and the last voxels are cells at the
// faces of the box, as in Mitsuba 3. Without a box in the file, it is the unit cube.
GridFile read_mitsuba_volume(const std::filesystem::path& file, Negative negative = Negative::clamp,
                             std::uint64_t most_voxels = max_voxels);

// The slices of VolVis (.slc): voxels of 8 bits, packed in runs or not. The box begins at the origin, and a voxel's
// edges are the spacing of the file.
GridFile read_slc(const std::filesystem::path& file, std::uint64_t most_voxels = max_voxels);

}  // namespace shadowbench::scene
