#include "scene/readers/voxel_values.h"

#include <Imath/half.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <span>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/readers/densities.h"

namespace shadowbench::scene {
namespace {

static_assert(std::endian::native == std::endian::little, "values of little-endian files are taken as they lie");

template <class T>
double number_at(const std::uint8_t* from, bool turn) {
    std::array<std::uint8_t, sizeof(T)> bytes{};
    std::copy_n(from, sizeof(T), bytes.begin());
    if (turn) std::reverse(bytes.begin(), bytes.end());
    return static_cast<double>(std::bit_cast<T>(bytes));
}

double half_at(const std::uint8_t* from, bool turn) {
    const unsigned low = from[turn ? 1 : 0], high = from[turn ? 0 : 1];
    return static_cast<double>(imath_half_to_float(static_cast<std::uint16_t>((high << 8) | low)));
}

struct TypeFacts {
    std::string_view name;
    std::uint64_t bytes;
    double largest;                                       // by which values are divided; 1: they are not
    double (*read)(const std::uint8_t* from, bool turn);  // turn: the bytes are in the other order
};
// In the order of ValueType.
constexpr std::array<TypeFacts, 9> types{{{"uint8", 1, 255.0, number_at<std::uint8_t>},
                                          {"int8", 1, 127.0, number_at<std::int8_t>},
                                          {"uint16", 2, 65535.0, number_at<std::uint16_t>},
                                          {"int16", 2, 32767.0, number_at<std::int16_t>},
                                          {"uint32", 4, 4294967295.0, number_at<std::uint32_t>},
                                          {"int32", 4, 2147483647.0, number_at<std::int32_t>},
                                          {"float16", 2, 1.0, half_at},
                                          {"float32", 4, 1.0, number_at<float>},
                                          {"float64", 8, 1.0, number_at<double>}}};

const TypeFacts& facts(ValueType type) {
    return types[static_cast<std::size_t>(type)];
}

}  // namespace

std::optional<ValueType> value_type(std::string_view name) {
    for (std::size_t i = 0; i < types.size(); ++i)
        if (types[i].name == name) return static_cast<ValueType>(i);
    return std::nullopt;
}

std::string_view name_of(ValueType type) {
    return facts(type).name;
}

std::uint64_t bytes_of_value(ValueType type) {
    return facts(type).bytes;
}

std::string value_type_names() {
    std::string names;
    for (std::size_t i = 0; i < types.size(); ++i)
        names.append(i == 0 ? "" : i + 1 < types.size() ? ", " : " or ").append(types[i].name);
    return names;
}

std::string text_of(const VoxelLayout& layout) {
    const TypeFacts& type = facts(layout.type);
    std::string text = fmt::format("values of {}", type.name);
    if (type.bytes > 1) text += layout.order == ByteOrder::big ? ", big-endian" : ", little-endian";
    if (layout.packing != Packing::none) text += ", packed";
    if (type.largest > 1.0) text += fmt::format(", divided by {}", type.largest);
    return text;
}

std::uint64_t count_voxels(const FileReader& file, std::uint64_t at, const Vec3i& size, std::uint64_t most_voxels) {
    if (size.x < 1 || size.y < 1 || size.z < 1) file.fail(at, "a volume needs at least one voxel along every axis");
    if (static_cast<double>(size.x) * size.y * size.z > static_cast<double>(most_voxels))
        file.fail(at, fmt::format("{} x {} x {} voxels; the limit is {}", size.x, size.y, size.z, most_voxels));
    return static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) * static_cast<std::uint64_t>(size.z);
}

GridVolume read_voxels(FileReader& file, const VoxelLayout& layout, Negative negative, Rest rest) {
    const TypeFacts& type = facts(layout.type);
    const auto voxels = static_cast<std::size_t>(layout.size.x) * static_cast<std::size_t>(layout.size.y) *
                        static_cast<std::size_t>(layout.size.z);
    UnpackedBytes bytes(file, layout.begin, layout.packing);
    bytes.need(layout.skip, "what is skipped");
    bytes.need(layout.skip + voxels * type.bytes, "voxels");
    bytes.pass(layout.skip, "what is skipped");

    GridVolume volume;
    volume.size = turned(layout.size, layout.axes);
    volume.density.resize(voxels);
    TurnedPlaces places(layout.size, layout.axes);
    const bool turn = layout.order == ByteOrder::big;
    constexpr std::size_t most_at_once = 1 << 16;
    std::vector<std::uint8_t> chunk(std::min(voxels, most_at_once) * type.bytes);
    for (std::size_t done = 0; done < voxels;) {
        const std::size_t count = std::min(most_at_once, voxels - done);
        const std::uint64_t from = bytes.position();
        bytes.read(std::span(chunk).first(count * type.bytes), "voxels");
        for (std::size_t i = 0; i < count; ++i) {
            const double value = type.read(chunk.data() + i * type.bytes, turn) / type.largest;
            if (!(std::abs(value) <= max_coordinate))
                bytes.fail(from + i * type.bytes,
                           fmt::format("voxels: {} is not a finite number of at most {}", value, max_coordinate));
            const auto density = static_cast<float>(value);
            if (density < 0.0f && negative == Negative::refuse)
                bytes.fail(from + i * type.bytes, negative_refused(density));
            volume.density[places.next()] = density;
        }
        done += count;
    }
    clamp_negatives(volume.density, volume.notes);
    const std::uint64_t end = bytes.position();
    if (!bytes.at_end()) {
        if (rest == Rest::refused) bytes.fail(end, "more follows the last voxel: the size, type or skip is wrong");
        volume.notes.lines.push_back("what follows its last voxel is passed over");
    }
    return volume;
}

}  // namespace shadowbench::scene
