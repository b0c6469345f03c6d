#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "scene/readers/densities.h"
#include "scene/readers/file_reader.h"
#include "scene/readers/files.h"

namespace shadowbench::scene {
namespace {

std::vector<float> read_uint8(FileReader& reader, std::uint64_t voxels) {
    const std::vector<std::uint8_t> bytes = reader.array<std::uint8_t>(voxels, "voxels");
    std::vector<float> density;
    density.reserve(bytes.size());
    for (const std::uint8_t byte : bytes) density.push_back(static_cast<float>(byte) / 255.0f);
    return density;
}

std::vector<float> read_float32(FileReader& reader, std::uint64_t voxels, Negative negative, ReadNotes& notes) {
    std::vector<float> density = reader.array<float>(voxels, "voxels");
    reader.check_finite(density, 0, "voxels");
    if (negative == Negative::clamp) {
        clamp_negatives(density, notes);
        return density;
    }
    for (std::size_t i = 0; i < density.size(); ++i)
        if (density[i] < 0.0f) reader.fail(i * sizeof(float), negative_refused(density[i]));
    return density;
}

}  // namespace

GridVolume read_raw_volume(const std::filesystem::path& file, Vec3i size, const std::string& type, Negative negative) {
    FileReader reader(file);
    if (size.x < 1 || size.y < 1 || size.z < 1) reader.fail(0, "a volume needs at least one voxel along every axis");
    if (type != "uint8" && type != "float32")
        reader.fail(0, fmt::format("the type \"{}\" is unknown; give uint8 or float32", type));
    const std::uint64_t row = static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y);
    const std::uint64_t bytes = type == "uint8" ? 1 : 4;
    // Divides, since the product of three sizes may not fit 64 bits.
    if (reader.size() % bytes != 0 || reader.size() / bytes % row != 0 ||
        reader.size() / bytes / row != static_cast<std::uint64_t>(size.z))
        reader.fail(reader.size(), fmt::format("the file has {} bytes, which is not {} x {} x {} values of {}",
                                               reader.size(), size.x, size.y, size.z, type));
    const std::uint64_t voxels = row * static_cast<std::uint64_t>(size.z);
    GridVolume volume;
    volume.size = size;
    volume.density =
        type == "uint8" ? read_uint8(reader, voxels) : read_float32(reader, voxels, negative, volume.notes);
    return volume;
}

}  // namespace shadowbench::scene
