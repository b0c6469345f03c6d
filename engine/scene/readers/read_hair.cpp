// The HAIR file format (Cem Yuksel, www.cemyuksel.com/research/hairmodels): a header of 128 bytes, then the arrays that
// its bits announce: segments (uint16, one for each strand), points, thickness, transparency and colours (float).
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/readers/file_reader.h"
#include "scene/readers/files.h"

namespace shadowbench::scene {
namespace {

enum Bit : std::uint32_t {
    has_segments = 1,
    has_points = 2,
    has_thickness = 4,
    has_transparency = 8,
    has_colours = 16
};

struct Header {
    char signature[4];
    std::uint32_t strands, points, bits;
    std::uint32_t default_segments;
    float default_thickness, default_transparency;
    float default_colour[3];
    char information[88];
};
static_assert(sizeof(Header) == 128);
constexpr std::uint64_t default_thickness_at = 20;

// Counts all arrays that the header announces, including those that are not read, to detect a file cut anywhere.
void check_size(const FileReader& reader, const Header& header) {
    if (std::memcmp(header.signature, "HAIR", 4) != 0) reader.fail(0, "the file does not begin with HAIR");
    if (!(header.bits & has_points)) reader.fail(12, "the file has no points");
    if (header.points > max_hair_points)
        reader.fail(8, fmt::format("{} points of hair; the limit is {}", header.points, max_hair_points));
    std::uint64_t bytes = header.bits & has_segments ? std::uint64_t{2} * header.strands : 0;
    std::uint64_t floats = 3;
    if (header.bits & has_thickness) floats += 1;
    if (header.bits & has_transparency) floats += 1;
    if (header.bits & has_colours) floats += 3;
    bytes += floats * 4 * header.points;
    reader.need(bytes, 1, "arrays");
}

std::vector<std::uint32_t> read_strands(FileReader& reader, const Header& header) {
    std::vector<std::uint16_t> segments;
    if (header.bits & has_segments) {
        segments = reader.array<std::uint16_t>(header.strands, "segments");
    } else if (header.strands > header.points) {
        reader.fail(4, fmt::format("the header states {} strands but only {} points", header.strands, header.points));
    }
    std::vector<std::uint32_t> begin{0};
    begin.reserve(header.strands + std::size_t{1});
    std::uint64_t total = 0;
    for (std::uint32_t i = 0; i < header.strands; ++i) {
        total += (segments.empty() ? header.default_segments : segments[i]) + std::uint64_t{1};
        if (total > header.points) break;
        begin.push_back(static_cast<std::uint32_t>(total));
    }
    if (total != header.points)
        reader.fail(8, fmt::format("the header states {} points, but the segments of the strands need {}{}",
                                   header.points, total > header.points ? "at least " : "", total));
    return begin;
}

}  // namespace

Hair read_hair(const std::filesystem::path& file, float radius) {
    FileReader reader(file);
    const Header header = reader.value<Header>("header");
    check_size(reader, header);
    Hair hair;
    hair.strand_begin = read_strands(reader, header);

    hair.points.reserve(header.points);
    for_each_block<float>(reader, std::uint64_t{3} * header.points, "points",
                          [&](const std::vector<float>& points, std::uint64_t at) {
                              reader.check_finite(points, at, "points");
                              for (std::size_t i = 0; i < points.size(); i += 3)
                                  hair.points.emplace_back(points[i], points[i + 1], points[i + 2]);
                          });
    hair.radii.reserve(header.points);
    const auto take_thickness = [&](const std::vector<float>& thickness, std::uint64_t at) {
        reader.check_finite(thickness, at, "thickness");
        for (std::size_t i = 0; i < thickness.size(); ++i) {
            if (thickness[i] < 0.0f) reader.fail(at + 4 * i, "a thickness is below 0");
            hair.radii.push_back(0.5f * thickness[i]);
        }
    };
    if (radius > 0.0f) {
        hair.radii.assign(header.points, radius);
    } else if (header.bits & has_thickness) {
        for_each_block<float>(reader, header.points, "thickness", take_thickness);
    } else {
        take_thickness({header.default_thickness}, default_thickness_at);
        const float half_width = hair.radii[0];
        hair.radii.assign(header.points, half_width);
    }
    return hair;
}

}  // namespace shadowbench::scene
