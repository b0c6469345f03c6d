// Volumes of Mitsuba, against values written by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "scene/readers/grid_files.h"
#include "scene/refusal.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::bytes_of;
using test::error_of;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int32_t float32 = 1, float16 = 2, uint8 = 3;

std::string header(std::int32_t encoding, std::int32_t x, std::int32_t y, std::int32_t z, std::int32_t channels = 1,
                   float lower = -1.0f, float upper = 2.0f) {
    return "VOL\x03" + bytes_of(encoding, x, y, z, channels, lower, lower, lower, upper, upper, upper);
}

GridFile read(const std::string& bytes, Negative negative = Negative::clamp, std::uint64_t most = max_voxels) {
    return read_mitsuba_volume(test::write_file("a.vol", bytes), negative, most);
}

std::string message(const std::string& bytes) {
    return test::message_at_byte("a.vol", [&] { read(bytes); });
}

TEST(ReadMitsubaVolume, ReadsXFastestIntoTheBoxOfTheFile) {
    const GridFile file = read(header(float32, 3, 1, 2) + bytes_of(0.0f, 1.5f, 2.0f, 3.0f, 4.0f, 5.0f));
    EXPECT_EQ(file.volume.size, Vec3i(3, 1, 2));
    EXPECT_THAT(file.volume.density, ElementsAre(0.0f, 1.5f, 2.0f, 3.0f, 4.0f, 5.0f));
    EXPECT_EQ(file.volume.lower, Vec3d(-1, -1, -1));
    EXPECT_EQ(file.volume.upper, Vec3d(2, 2, 2));
    EXPECT_THAT(file.facts, ElementsAre("values of float32, little-endian"));
    EXPECT_TRUE(file.volume.notes.lines.empty());
}

TEST(ReadMitsubaVolume, ReadsHalvesAndBytes) {
    // 1, 1.5, the largest half, and the smallest above 0: 2^-24.
    const std::string halves =
        bytes_of(std::uint16_t{0x3c00}, std::uint16_t{0x3e00}, std::uint16_t{0x7bff}, std::uint16_t{0x0001});
    EXPECT_THAT(read(header(float16, 4, 1, 1) + halves).volume.density, ElementsAre(1.0f, 1.5f, 65504.0f, 0x1p-24f));
    EXPECT_THAT(read(header(uint8, 2, 1, 1) + "\x33\xff").volume.density, ElementsAre(0.2f, 1.0f));
    EXPECT_THAT(message(header(float16, 1, 1, 1) + bytes_of(std::uint16_t{0x7c00})), HasSubstr("not a finite number"));
}

// As Mitsuba does with files that it writes from arrays without a box.
TEST(ReadMitsubaVolume, TakesTheUnitCubeForABoxWithoutSize) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const float corner : {0.0f, infinity, std::numeric_limits<float>::quiet_NaN()}) {
        const GridVolume volume = read(header(uint8, 1, 1, 1, 1, corner, -corner) + "a").volume;
        EXPECT_EQ(volume.lower, Vec3d(0, 0, 0));
        EXPECT_EQ(volume.upper, Vec3d(1, 1, 1));
        EXPECT_THAT(volume.notes.lines, ElementsAre(HasSubstr("the unit cube is taken")));
    }
}

TEST(ReadMitsubaVolume, TakesOrRefusesDensitiesBelow0) {
    const std::string bytes = header(float32, 2, 1, 1) + bytes_of(-0.5f, 1.0f);
    EXPECT_THAT(read(bytes).volume.notes.lines, ElementsAre(HasSubstr("1 of 2 densities are below 0")));
    const base::Error error = error_of([&] { read(bytes, Negative::refuse); });
    EXPECT_THAT(error.where(), HasSubstr("byte 48"));
    EXPECT_THAT(error.message(), HasSubstr("below 0"));
}

TEST(ReadMitsubaVolume, NamesTheFaultsOfAHeader) {
    EXPECT_THAT(message("VOM\x03"), HasSubstr("not a volume of Mitsuba"));
    EXPECT_THAT(message("VOL\x02" + std::string(60, '\0')), HasSubstr("version 2"));
    EXPECT_THAT(message(header(4, 1, 1, 1) + "abcd"), HasSubstr("encoding 4"));
    EXPECT_THAT(message(header(uint8, 1, 1, 1, 3) + "abc"), HasSubstr("3 channels"));
    EXPECT_EQ(error_of([] { read_mitsuba_volume("/nowhere/a.vol"); }).code(), base::ErrorCode::no_such_file);
}

// None of these may take the memory or the time that its header asks for.
TEST(ReadMitsubaVolume, RefusesHostileSizes) {
    constexpr std::int32_t largest = std::numeric_limits<std::int32_t>::max();
    EXPECT_THAT(message(header(uint8, 0, 1, 1)), HasSubstr("at least one voxel"));
    EXPECT_THAT(message(header(uint8, -1, -1, 1) + "a"), HasSubstr("at least one voxel"));
    EXPECT_THAT(message(header(uint8, largest, largest, largest)), HasSubstr("limit is 1000000000"));
    EXPECT_THAT(message(header(float32, 1000, 1000, 1000)), HasSubstr("too short"));
    EXPECT_THAT(error_of([] { read(header(uint8, 3, 1, 1) + "abc", Negative::clamp, 2); }).message(),
                HasSubstr("limit is 2"));
}

TEST(ReadMitsubaVolume, RefusesAFileCutAnywhere) {
    const std::string bytes = header(uint8, 2, 2, 1) + "abcd";
    test::expect_cuts_refused(bytes, "cut.vol", bytes.size(), [](const auto& file) { read_mitsuba_volume(file); });
}

TEST(ReadMitsubaVolume, GivesAVolumeOrAnErrorWhateverByteIsChanged) {
    test::expect_changes_survived(header(uint8, 2, 2, 1) + "abcd", "changed.vol", [](const auto& file) {
        return read_mitsuba_volume(file, Negative::clamp, 1 << 16).volume;
    });
}

}  // namespace
}  // namespace shadowbench::scene
