// Slices of VolVis, against values written by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include <fmt/format.h>

#include "scene/readers/grid_files.h"
#include "scene/refusal.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::error_of;
using testing::ElementsAre;
using testing::HasSubstr;

// With an icon of 1 x 2 pixels.
std::string header(const std::string& size, int packing, const std::string& spacing = "1.0 0.5 2", int bits = 8) {
    return fmt::format("11111\n{} {}\n{}\n1 0 4 {}\n1 2 X", size, bits, spacing, packing) + "iconXX";
}

GridFile read(const std::string& bytes, std::uint64_t most = max_voxels) {
    return read_slc(test::write_file("a.slc", bytes), most);
}

std::string message(const std::string& bytes) {
    return test::message_at_byte("a.slc", [&] { read(bytes); });
}

TEST(ReadSlc, ReadsSlicesXFastestWithTheSpacingOfTheFile) {
    const GridFile file = read(header("3 1 2", 0) + std::string("\x00\x33\x66\x99\xcc\xff", 6));
    EXPECT_EQ(file.volume.size, Vec3i(3, 1, 2));
    EXPECT_THAT(file.volume.density, ElementsAre(0.0f, 0.2f, 0.4f, 0.6f, 0.8f, 1.0f));
    EXPECT_EQ(file.volume.lower, Vec3d(0, 0, 0));
    EXPECT_EQ(file.volume.upper, Vec3d(3, 0.5, 4));
    EXPECT_THAT(file.facts, ElementsAre("values of uint8, divided by 255", "unit of its spacing: number 1 of VolVis"));
    EXPECT_TRUE(file.volume.notes.lines.empty());
    EXPECT_THAT(read(header("1 1 1", 0) + "ab").volume.notes.lines, ElementsAre(HasSubstr("is passed over")));
}

// The first byte of a slice follows its X at once, even if it is a blank or a digit.
TEST(ReadSlc, UnpacksRunsAndValuesThatDoNotRepeat) {
    const std::string equal("\x04\xff\x00", 3), mixed("\x82\x33\x66\x02\x99\x00", 6);
    const GridFile file = read(header("2 2 2", 1) + "3 X" + equal + "6 X" + mixed);
    EXPECT_THAT(file.volume.density, ElementsAre(1.0f, 1.0f, 1.0f, 1.0f, 0.2f, 0.4f, 0.6f, 0.6f));
    EXPECT_THAT(file.facts, testing::Contains("values of uint8, packed, divided by 255"));
    const std::string long_runs = std::string("\x7f ", 2) + "\x7f " + "\x02 " + std::string(1, '\0');
    EXPECT_THAT(read(header("256 1 1", 1) + "7\nX" + long_runs).volume.density, testing::Each(32.0f / 255.0f));
    const std::string blanks("\x8a 1 2 3 4 5\x00", 12);
    EXPECT_EQ(read(header("10 1 1", 1) + "12 X" + blanks).volume.density[1], '1' / 255.0f);
}

// Woolz packs slices so. Refusing these would refuse all of its files.
TEST(ReadSlc, TakesSlicesWithoutTheirLastVoxel) {
    const std::string short_runs("\x03\xff\x00", 3), all("\x04\xff\x00", 3);
    const GridVolume volume = read(header("2 2 2", 1) + "3 X" + short_runs + "3 X" + all).volume;
    EXPECT_THAT(volume.density, ElementsAre(1.0f, 1.0f, 1.0f, 0.0f, 1.0f, 1.0f, 1.0f, 1.0f));
    EXPECT_THAT(volume.notes.lines, ElementsAre("the last voxel of 1 of 2 slices is missing: 0 is taken"));
}

TEST(ReadSlc, RefusesRunsThatAreNotASlice) {
    EXPECT_THAT(message(header("2 2 1", 1) + "3 X" + std::string("\x05\xff\x00", 3)), HasSubstr("more voxels than"));
    EXPECT_THAT(message(header("2 2 1", 1) + "3 X" + std::string("\x02\xff\x00", 3)),
                HasSubstr("a slice of 4 voxels has 2"));
    EXPECT_THAT(message(header("2 2 1", 1) + "2 X" + std::string("\x04\xff", 2)), HasSubstr("ends inside its runs"));
    EXPECT_THAT(message(header("2 2 1", 1) + "2 X" + std::string("\x84\xff", 2)), HasSubstr("ends inside its runs"));
    EXPECT_THAT(message(header("2 2 1", 1) + "0 X"), HasSubstr("ends inside its runs"));
    EXPECT_THAT(message(header("2 2 1", 1) + "3 Y\x04\xff"), HasSubstr("an X must stand"));
    EXPECT_THAT(message(header("2 2 1", 1) + "-3 X\x04\xff"), HasSubstr("needs a number"));
}

TEST(ReadSlc, NamesTheFaultsOfAHeader) {
    EXPECT_THAT(message("11112 1 1 1 8 "), HasSubstr("not a volume of VolVis"));
    EXPECT_THAT(message("P5\n1 1\n255\nx"), HasSubstr("needs a number here: the magic number"));
    EXPECT_THAT(message(header("0 1 1", 0)), HasSubstr("at least one voxel"));
    EXPECT_THAT(message(header("1.5 1 1", 0)), HasSubstr("needs a number"));
    EXPECT_THAT(message(header("1 1 1", 2) + "a"), HasSubstr("packing 2"));
    EXPECT_THAT(message(header("1 1 1", 0, "1 1 1", 16) + "ab"), HasSubstr("voxels of 16 bits"));
    for (const char* spacing : {"0 1 1", "1 -1 1", "nan 1 1"})
        EXPECT_THAT(message(header("1 1 1", 0, spacing) + "a"), HasSubstr("must be above 0")) << spacing;
    EXPECT_THAT(message(header("1 1 1", 0, "inf 1 1") + "a"), HasSubstr("at most"));
    EXPECT_THAT(message("11111 1 1 1 8 1 1 1 1 0 0 0 -1 1 Xa"), HasSubstr("an icon of -1 pixels"));
    EXPECT_EQ(error_of([] { read_slc("/nowhere/a.slc"); }).code(), base::ErrorCode::no_such_file);
}

// None of these may take the memory or the time that its header asks for.
TEST(ReadSlc, RefusesHostileSizes) {
    EXPECT_THAT(message(header("2000 2000 2000", 0)), HasSubstr("limit is 1000000000"));
    EXPECT_THAT(message(header("1000 1000 1000", 0) + "a"), HasSubstr("too short"));
    EXPECT_THAT(message(header("1000 1000 1000", 1) + "3 Xabc"), HasSubstr("too short"));
    EXPECT_THAT(message(header("1 1 1", 1) + "99999999999 Xabc"), HasSubstr("too short"));
    EXPECT_THAT(message("11111 1 1 1 8 1 1 1 1 0 0 0 16000 16000 Xa"), HasSubstr("too short"));
    EXPECT_THAT(error_of([] { read(header("3 1 1", 0) + "abc", 2); }).message(), HasSubstr("limit is 2"));
}

TEST(ReadSlc, RefusesAFileCutAnywhere) {
    for (const std::string& bytes :
         {header("2 2 1", 0) + "abcd", header("2 2 1", 1) + "3 X" + std::string("\x04\xff\x00", 3)})
        test::expect_cuts_refused(bytes, "cut.slc", bytes.size(), [](const auto& file) { read_slc(file); });
}

TEST(ReadSlc, GivesAVolumeOrAnErrorWhateverByteIsChanged) {
    for (const std::string& bytes :
         {header("2 2 1", 0) + "abcd", header("2 2 1", 1) + "3 X" + std::string("\x04\xff\x00", 3)})
        test::expect_changes_survived(bytes, "changed.slc",
                                      [](const auto& file) { return read_slc(file, 1 << 16).volume; });
}

}  // namespace
}  // namespace shadowbench::scene
