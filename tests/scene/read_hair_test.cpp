#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include <fmt/format.h>

#include "scene/readers/files.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::bytes_of;
using test::error_of;
using testing::ElementsAre;
using testing::HasSubstr;

enum : std::uint32_t { segments_bit = 1, points_bit = 2, thickness_bit = 4, transparency_bit = 8, colours_bit = 16 };

std::string header(std::uint32_t strands, std::uint32_t points, std::uint32_t bits, std::uint32_t segments = 0,
                   float thickness = 0.5f) {
    return "HAIR" + bytes_of(strands, points, bits, segments, thickness, 0.0f, 1.0f, 1.0f, 1.0f) + std::string(88, ' ');
}

// Strands of 2 and 3 points, with every kind of array.
std::string full(float thickness = 0.2f, float coordinate = 5.0f) {
    std::string bytes = header(2, 5, segments_bit | points_bit | thickness_bit | transparency_bit | colours_bit);
    bytes += bytes_of(std::uint16_t{1}, std::uint16_t{2});
    for (const float x : {1.0f, 2.0f, 3.0f, 4.0f, coordinate}) bytes += bytes_of(x, 0.0f, -x);
    bytes += bytes_of(0.1f, 0.2f, 0.3f, 0.4f, thickness);
    bytes += std::string(5 * 4 + 15 * 4, '\0');
    return bytes;
}

Hair read(const std::string& bytes, float radius = 0.0f) {
    return read_hair(test::write_file("a.hair", bytes), radius);
}

TEST(ReadHair, ReadsEveryArray) {
    const Hair hair = read(full());
    EXPECT_THAT(hair.strand_begin, ElementsAre(0u, 2u, 5u));
    EXPECT_EQ(hair.points[4], Vec3f(5, 0, -5));
    // The file's thickness is the full width.
    EXPECT_THAT(hair.radii, ElementsAre(0.05f, 0.1f, 0.15f, 0.2f, 0.1f));
}

TEST(ReadHair, ARadiusOverridesTheFile) {
    EXPECT_THAT(read(full(), 2.0f).radii, testing::Each(2.0f));
}

TEST(ReadHair, UsesTheHeadersDefaultsWithoutArrays) {
    const Hair hair = read(header(2, 4, points_bit, 1, 0.5f) + std::string(4 * 12, '\0'));
    EXPECT_THAT(hair.strand_begin, ElementsAre(0u, 2u, 4u));
    EXPECT_THAT(hair.radii, testing::Each(0.25f));
}

TEST(ReadHair, RefusesAFileCutAnywhere) {
    test::expect_cuts_refused(full(), "cut.hair", full().size(), [](const auto& file) { read_hair(file, 0.0f); });
}

TEST(ReadHair, PointsAtTheByteOfABadValue) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto place = [](const std::string& bytes) {
        const std::string where = error_of([&] { read(bytes); }).where();
        return where.substr(where.rfind(':') + 1);
    };
    EXPECT_EQ(place(full(0.2f, nan)), fmt::format(" byte {}", 128 + 4 + 12 * 4));
    EXPECT_EQ(place(full(nan)), fmt::format(" byte {}", 128 + 4 + 60 + 16));
    EXPECT_EQ(place(full(-0.1f)), fmt::format(" byte {}", 128 + 4 + 60 + 16));
    EXPECT_EQ(place(header(1, 2, points_bit, 1, nan) + std::string(24, '\0')), " byte 20");
}

TEST(ReadHair, RefusesCountsThatDisagree) {
    std::string bytes = full();
    bytes[128] = 7;  // the first strand's segments
    EXPECT_THAT(error_of([&] { read(bytes); }).message(), HasSubstr("states 5 points"));
    bytes[128] = 0;
    EXPECT_THAT(error_of([&] { read(bytes); }).message(), HasSubstr("need 4"));
    EXPECT_EQ(error_of([&] { read(header(0xffffffffu, 2, points_bit, 0) + std::string(24, '\0')); }).code(),
              base::ErrorCode::bad_input);
}

TEST(ReadHair, RefusesCountsTheFileCannotHoldBeforeMemoryIsTaken) {
    EXPECT_THAT(error_of([] { read(header(1, 0xffffffffu, points_bit, 1)); }).message(), HasSubstr("limit"));
    EXPECT_THAT(error_of([] { read(header(0xffffffffu, 100000000, segments_bit | points_bit)); }).message(),
                HasSubstr("too short"));
}

TEST(ReadHair, RefusesAnotherFormatAndAFileWithoutPoints) {
    EXPECT_THAT(error_of([] { read(std::string(200, 'x')); }).message(), HasSubstr("HAIR"));
    EXPECT_THAT(error_of([] { read(header(0, 0, segments_bit)); }).message(), HasSubstr("no points"));
}

}  // namespace
}  // namespace shadowbench::scene
