#include <algorithm>

#include <fmt/format.h>

#include "scene/readers/extension.h"
#include "scene/readers/grid_files.h"

namespace shadowbench::scene {
namespace {

// Without packing, the file has exactly as many bytes as the format needs.
void check_length(const FileReader& file, const RawFormat& format) {
    const Vec3i& size = format.size;
    const std::uint64_t bytes = bytes_of_value(format.type),
                        row = static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y);
    // Divides, since the product of three sizes may not fit 64 bits.
    const std::uint64_t left = file.size() - std::min(file.size(), format.skip);
    if (file.size() < format.skip || left % bytes != 0 || left / bytes % row != 0 ||
        left / bytes / row != static_cast<std::uint64_t>(size.z))
        file.fail(file.size(), fmt::format("the file has {} bytes, which is not {} x {} x {} values of {}{}",
                                           file.size(), size.x, size.y, size.z, name_of(format.type),
                                           format.skip > 0 ? fmt::format(" behind {} others", format.skip) : ""));
}

}  // namespace

GridVolume read_raw_values(const std::filesystem::path& file, const RawFormat& format, Negative negative) {
    FileReader reader(file);
    if (format.size.x < 1 || format.size.y < 1 || format.size.z < 1)
        reader.fail(0, "a volume needs at least one voxel along every axis");
    VoxelLayout layout;
    layout.packing = extension_of(file) == ".gz" ? Packing::deflate : Packing::none;
    if (layout.packing == Packing::none) check_length(reader, format);
    count_voxels(reader, 0, format.size, max_voxels);
    layout.size = format.size;
    layout.type = format.type;
    layout.order = format.order;
    layout.skip = format.skip;
    return read_voxels(reader, layout, negative, Rest::refused);
}

GridVolume read_raw_volume(const std::filesystem::path& file, Vec3i size, const std::string& type, Negative negative) {
    const std::optional<ValueType> known = value_type(type);
    if (!known) FileReader(file).fail(0, fmt::format("the type \"{}\" is unknown; give {}", type, value_type_names()));
    RawFormat format;
    format.size = size;
    format.type = *known;
    return read_raw_values(file, format, negative);
}

}  // namespace shadowbench::scene
