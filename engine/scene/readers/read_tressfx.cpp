// TressFX hair (AMD GPUOpen). Version 3 has positions of three floats at a fixed offset after the header. Version 4 is
// as in TressFXAsset.h (TressFXTFXFileHeader): the header holds their offset, and they have four floats, the last of
// which is the inverse mass.
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/readers/file_reader.h"
#include "scene/readers/files.h"

namespace shadowbench::scene {
namespace {

constexpr std::uint64_t version_3_positions = 296;
constexpr std::uint64_t version_4_header = 160;

}  // namespace

Hair read_tressfx(const std::filesystem::path& file, float radius) {
    FileReader reader(file);
    const auto version = reader.value<float>("header");
    if (!(version >= 3.0f && version < 5.0f))
        reader.fail(0, fmt::format("TressFX version {} is not supported; versions 3 and 4 are", version));
    const auto strands = reader.value<std::uint32_t>("header");
    const auto per_strand = reader.value<std::uint32_t>("header");
    if (per_strand < 2) reader.fail(8, fmt::format("the strands have {} points each; a segment needs 2", per_strand));
    const std::uint64_t count = static_cast<std::uint64_t>(strands) * per_strand;
    if (count > max_hair_points)
        reader.fail(4, fmt::format("{} points of hair; the limit is {}", count, max_hair_points));

    const std::uint64_t words = version < 4.0f ? 3 : 4;
    std::uint64_t offset = version_3_positions;
    if (version >= 4.0f) {
        offset = reader.value<std::uint32_t>("header");
        if (offset < version_4_header) reader.fail(12, fmt::format("positions at byte {} overlap the header", offset));
    }
    reader.seek(offset, "positions");
    reader.need(count * words, sizeof(float), "positions");

    Hair hair;
    hair.points.reserve(count);
    for_each_block<float>(reader, count * words, "positions", [&](const std::vector<float>& values, std::uint64_t at) {
        for (std::size_t i = 0; i < values.size(); i += words) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (!(std::abs(values[i + axis]) <= static_cast<float>(max_coordinate)))
                    reader.fail(at + (i + axis) * sizeof(float), "a position is not finite");
            hair.points.emplace_back(values[i], values[i + 1], values[i + 2]);
        }
    });
    hair.radii.assign(count, radius);
    hair.strand_begin.reserve(strands + std::size_t{1});
    for (std::uint64_t s = 0; s <= strands; ++s)
        hair.strand_begin.push_back(static_cast<std::uint32_t>(s * per_strand));
    return hair;
}

}  // namespace shadowbench::scene
