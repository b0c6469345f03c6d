// Layout: Mitsuba 3, src/render/volumegrid.cpp and the documentation of its grid-based volumes.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include <fmt/format.h>

#include "scene/readers/grid_files.h"

namespace shadowbench::scene {
namespace {

constexpr std::array<std::uint8_t, 3> magic{'V', 'O', 'L'};
constexpr std::uint8_t version = 3;

struct Encoding {
    std::int32_t number;
    ValueType type;
};
constexpr Encoding encodings[] = {{1, ValueType::float32}, {2, ValueType::float16}, {3, ValueType::uint8}};

void check_front(FileReader& file) {
    const std::vector<std::uint8_t> front = file.array<std::uint8_t>(magic.size() + 1, "header");
    if (!std::equal(magic.begin(), magic.end(), front.begin()))
        file.fail(0, "not a volume of Mitsuba: VOL does not stand at its front");
    if (front.back() != version)
        file.fail(magic.size(), fmt::format("version {} of the format; version 3 is read", front.back()));
}

ValueType read_encoding(FileReader& file) {
    const std::uint64_t at = file.position();
    const auto number = file.value<std::int32_t>("header");
    const auto* known = std::find_if(std::begin(encodings), std::end(encodings),
                                     [&](const Encoding& one) { return one.number == number; });
    if (known == std::end(encodings))
        file.fail(at, fmt::format("encoding {}; float32 (1), float16 (2) and uint8 (3) are read", number));
    return known->type;
}

// Files that state no box have one that is empty, of no number or unbounded.
void read_box(FileReader& file, GridVolume& volume) {
    std::array<Vec3d, 2> corners;
    corners.fill(Vec3d(0, 0, 0));
    for (Vec3d& corner : corners)
        for (int axis = 0; axis < 3; ++axis) corner[axis] = static_cast<double>(file.value<float>("header"));
    volume.lower = corners[0];
    volume.upper = corners[1];
    if (!box_fault(volume.lower, volume.upper)) return;
    volume.lower = Vec3d(0, 0, 0);
    volume.upper = Vec3d(1, 1, 1);
    volume.notes.lines.push_back("the file states no box that has a size: the unit cube is taken");
}

}  // namespace

GridFile read_mitsuba_volume(const std::filesystem::path& file, Negative negative, std::uint64_t most_voxels) {
    FileReader reader(file);
    check_front(reader);
    VoxelLayout layout;
    layout.type = read_encoding(reader);
    const std::uint64_t size_at = reader.position();
    for (int axis = 0; axis < 3; ++axis) layout.size[axis] = reader.value<std::int32_t>("header");
    count_voxels(reader, size_at, layout.size, most_voxels);
    const std::uint64_t channels_at = reader.position();
    const auto channels = reader.value<std::int32_t>("header");
    if (channels != 1)
        reader.fail(channels_at,
                    fmt::format("{} channels; a volume of one channel is read: write one alone", channels));
    GridVolume place;
    read_box(reader, place);
    layout.begin = reader.position();

    GridFile result{read_voxels(reader, layout, negative, Rest::noted), {text_of(layout)}};
    result.volume.lower = place.lower;
    result.volume.upper = place.upper;
    result.volume.notes.lines.insert(result.volume.notes.lines.begin(), place.notes.lines.begin(),
                                     place.notes.lines.end());
    return result;
}

}  // namespace shadowbench::scene
