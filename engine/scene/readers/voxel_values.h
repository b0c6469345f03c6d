// Voxels as volume files store them: values of several types and byte orders, packed or not.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/readers/file_reader.h"
#include "scene/readers/files.h"
#include "scene/readers/grid_axes.h"
#include "scene/readers/unpacked_bytes.h"

namespace shadowbench::scene {

enum class ValueType { uint8, int8, uint16, int16, uint32, int32, float16, float32, float64 };
enum class ByteOrder { little, big };

// By its name above.
std::optional<ValueType> value_type(std::string_view name);
std::string_view name_of(ValueType type);
std::uint64_t bytes_of_value(ValueType type);

// All names: "uint8, int8, ... or float64".
std::string value_type_names();

struct VoxelLayout {
    Vec3i size{0, 0, 0};  // in the file
    GridAxes axes;
    ValueType type = ValueType::uint8;
    ByteOrder order = ByteOrder::little;
    Packing packing = Packing::none;
    std::uint64_t begin = 0;  // byte of the file at which the voxels, or what they are packed into, begin
    std::uint64_t skip = 0;   // unpacked bytes in front of the first voxel
};

// For people: "values of int16, big-endian, packed, divided by 32767".
std::string text_of(const VoxelLayout& layout);

// The number of voxels. Throws Error{bad_input} at a byte of the file unless every side is at least 1 and there are at
// most `most_voxels`.
std::uint64_t count_voxels(const FileReader& file, std::uint64_t at, const Vec3i& size, std::uint64_t most_voxels);

// Whether something follows the voxels in the file.
enum class Rest { refused, noted };

// A volume of the layout's voxels, of which count_voxels() has taken the size. Values of integer types are divided by
// the largest of their type. Throws Error{bad_input} at the first value that is not finite or is beyond max_coordinate;
// before memory is allocated, if the file is too short. The caller sets the box and step.
GridVolume read_voxels(FileReader& file, const VoxelLayout& layout, Negative negative, Rest rest);

}  // namespace shadowbench::scene
