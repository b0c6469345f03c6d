#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "base/random.h"
#include "scene/packed_bits.h"
#include "scene/readers/bit_runs.h"
#include "scene/readers/files.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::error_of;
using test::pack_bits;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

GridVolume read(const std::string& bytes, std::uint64_t most_voxels = max_voxels) {
    return read_pvm(test::write_file("a.pvm", bytes), most_voxels);
}

std::string message(const std::string& bytes) {
    return error_of([&] { read(bytes); }).message();
}

std::vector<std::uint8_t> unpack(const std::string& packed, std::size_t block_groups = 0,
                                 std::uint64_t most_bytes = 1 << 20) {
    const FileReader file(test::write_file("runs", packed));
    const std::vector<std::uint8_t> bytes(packed.begin(), packed.end());
    return unpack_bit_runs(file, bytes, 0, block_groups, most_bytes);
}

// --- runs of differences ---------------------------------------------------------------------------------------------

TEST(BitRuns, GiveTheBytesOfAStreamWrittenByHand) {
    test::BitWriter bits;
    bits.put("00 0000000000000000");            // groups and rows of one byte
    bits.put("0000011 001 11 11 01");           // three values of 2 bits: +1, +1, -1
    bits.put("0000010 000");                    // two of 0 bits
    bits.put("0000010 111 10000101 00000000");  // two of 8 bits: +5, -128
    bits.put("0000000");
    EXPECT_THAT(unpack(bits.finish()), ElementsAre(1, 2, 1, 1, 1, 6, 134));
}

TEST(BitRuns, PredictFromTheRowBefore) {
    test::BitWriter bits;
    bits.put("00 0000000000000001");   // rows of two bytes
    bits.put("0000011 110 0001010 ");  // 7 bits: -54, then two more
    bits.put("1001010 1001010");       // +10, +10
    bits.put("0000010 000");           // 212 + 212 - 202, 222 + 222 - 212
    EXPECT_THAT(unpack(bits.finish()), ElementsAre(202, 212, 222, 232, 242));
}

TEST(BitRuns, SortTheBytesOfGroupsBack) {
    const std::string bytes = "aAbBcCdDeE";
    const std::vector<std::uint8_t> expected(bytes.begin(), bytes.end());
    EXPECT_EQ(unpack(pack_bits(bytes, 2, 1)), expected);
    EXPECT_EQ(unpack(pack_bits(bytes, 2, 1, 2), 2), expected) << "blocks of two groups, and a rest";
    EXPECT_NE(unpack(pack_bits(bytes, 2, 1, 2)), expected);
    EXPECT_EQ(unpack(pack_bits(bytes, 3, 1)), expected) << "the last group is not complete";
}

TEST(BitRuns, AreExactForRandomBytesGroupsAndRows) {
    base::Random random(3);
    for (int round = 0; round < 60; ++round) {
        std::string bytes(random.below(2000), '\0');
        const std::uint64_t rough = std::uint64_t{1} << random.below(9);
        for (char& byte : bytes) byte = static_cast<char>(random.below(rough));
        const auto group = static_cast<unsigned>(1 + random.below(4)),
                   row = static_cast<unsigned>(1 + random.below(70));
        const std::size_t block = random.below(2) * (1 + random.below(100));
        const std::vector<std::uint8_t> expected(bytes.begin(), bytes.end());
        EXPECT_EQ(unpack(pack_bits(bytes, group, row, block), block), expected) << "round " << round;
    }
}

TEST(BitRuns, RefuseMoreBytesThanTheLimitBeforeTheyAreUnpacked) {
    const std::string packed = pack_bits(std::string(1000, 'x'), 1, 1);
    EXPECT_EQ(unpack(packed, 0, 1000).size(), 1000u);
    EXPECT_THAT(error_of([&] { unpack(packed, 0, 999); }).message(), HasSubstr("more than 999 bytes"));
}

// --- volumes ---------------------------------------------------------------------------------------------------------

TEST(ReadPvm, ReadsVoxelsOf8BitsXFastest) {
    const GridVolume volume = read("PVM\n3 2 1\n1\n" + std::string("\x00\x33\x66\x99\xcc\xff", 6));
    EXPECT_EQ(volume.size, Vec3i(3, 2, 1));
    EXPECT_THAT(volume.density, ElementsAre(0.0f, 0.2f, 0.4f, 0.6f, 0.8f, 1.0f));
    EXPECT_EQ(volume.lower, Vec3d(0, 0, 0));
    EXPECT_EQ(volume.upper, Vec3d(3, 2, 1));
}

TEST(ReadPvm, ReadsVoxelsOf16BitsWithTheHighByteFirst) {
    const GridVolume volume = read("PVM\n3 1 1\n2\n" + std::string("\x00\x01\x01\x00\xff\xff", 6));
    EXPECT_THAT(volume.density, ElementsAre(1.0f / 65535.0f, 256.0f / 65535.0f, 1.0f));
}

TEST(ReadPvm, TakesTheSpacingAndTheTextsOfNewerVersions) {
    const std::string texts("a box\0\0mine\0 \0", 14);
    for (const auto& [magic, end] : {std::pair{"PVM2", std::string()}, std::pair{"PVM3", texts}}) {
        const GridVolume volume = read(fmt::format("{}\n2 1 4\n0.5 1 2.5e-1\n1\nabcdefgh", magic) + end);
        EXPECT_EQ(volume.size, Vec3i(2, 1, 4));
        EXPECT_EQ(volume.upper, Vec3d(1, 1, 1));
        EXPECT_EQ(volume.density[2], 'c' / 255.0f);
    }
}

TEST(ReadPvm, PassesOverComments) {
    EXPECT_EQ(read("PVM\n# 9 9 9\n#\n2 1 1 # two\n1\nab").density.size(), 2u);
}

// A volume of 8 or 16 bits as the V3 library packs it: groups are the bytes of a voxel, rows are as long as a volume's
// row has voxels.
std::string packed_volume(const char* magic, int bytes) {
    std::string content = fmt::format("PVM3\n7 5 3\n1 1 2\n{}\n", bytes);
    for (int i = 0; i < 7 * 5 * 3 * bytes; ++i)
        content += static_cast<char>(bytes == 1 ? 2 * i : i % 2 ? 17 * i : i / 20);
    return magic + pack_bits(content + std::string("d\0c\0p\0m\0", 8), static_cast<unsigned>(bytes), 7);
}

TEST(ReadPvm, UnpacksFilesOfBothKinds) {
    for (const char* magic : {"DDS v3d\n", "DDS v3e\n"}) {
        const GridVolume small = read(packed_volume(magic, 1)), fine = read(packed_volume(magic, 2));
        EXPECT_EQ(small.size, Vec3i(7, 5, 3));
        EXPECT_EQ(small.upper, Vec3d(7, 5, 6));
        ASSERT_EQ(small.density.size(), 105u);
        ASSERT_EQ(fine.density.size(), 105u);
        for (int v = 0; v < 105; ++v) {
            EXPECT_EQ(small.density[static_cast<std::size_t>(v)], static_cast<float>(2 * v) / 255.0f);
            const int high = 2 * v / 20, low = 17 * (2 * v + 1) % 256;
            EXPECT_EQ(fine.density[static_cast<std::size_t>(v)], static_cast<float>(256 * high + low) / 65535.0f);
        }
    }
}

TEST(ReadPvm, RefusesAFileCutAnywhereAndOtherFiles) {
    const std::string plain = "PVM3\n2 2 1\n1 1 1\n1\nabcd" + std::string(4, '\0');
    EXPECT_NO_THROW(read(plain));
    for (const std::string& bytes : {plain, packed_volume("DDS v3d\n", 1), packed_volume("DDS v3e\n", 2)})
        for (std::size_t length = 0; length < bytes.size(); ++length) {
            const auto file = test::write_file("cut.pvm", bytes.substr(0, length));
            const base::Error error = error_of([&] { read_pvm(file); });
            EXPECT_EQ(error.code(), base::ErrorCode::bad_input) << "cut at " << length;
            EXPECT_TRUE(error.where().starts_with(file.string() + ": byte ")) << error.what();
        }
    EXPECT_THAT(message("P5\n1 1\n255\nx"), HasSubstr("not a PVM volume"));
    EXPECT_THAT(message("DDS v3d\n" + pack_bits("something", 1, 1)),
                AllOf(HasSubstr("unpacks"), HasSubstr("not a PVM")));
    EXPECT_THAT(message(plain + "x"), HasSubstr("1 bytes follow"));
    EXPECT_EQ(error_of([] { read_pvm("/nowhere/a.pvm"); }).code(), base::ErrorCode::no_such_file);
}

TEST(ReadPvm, GivesAVolumeOrAnErrorWhateverByteIsChanged) {
    const std::string plain = "PVM3\n2 2 1\n1 1 1\n1\nabcd" + std::string(4, '\0');
    for (const std::string& bytes : {plain, packed_volume("DDS v3d\n", 1), packed_volume("DDS v3e\n", 2)})
        test::expect_changes_survived(bytes, "changed.pvm", [](const auto& file) { return read_pvm(file, 1 << 16); });
}

TEST(ReadPvm, NamesTheFaultsOfAHeader) {
    EXPECT_THAT(message("PVM\n2 0 1\n1\nab"), HasSubstr("0 voxels along an axis"));
    EXPECT_THAT(message("PVM\n2 x 1\n1\nab"), HasSubstr("needs a number"));
    EXPECT_THAT(message("PVM\n2 1.5 1\n1\nab"), HasSubstr("needs a number"));
    EXPECT_THAT(message("PVM\n2 99999999999 1\n1\nab"), HasSubstr("needs a number"));
    EXPECT_THAT(message("PVM\n2 1 1\n3\nababab"), HasSubstr("voxels of 3 bytes"));
    EXPECT_THAT(message("PVM\n2 1 1\n1 ab"), HasSubstr("the line of the header must end here"));
    for (const char* spacing : {"0 1 1", "1 -1 1", "1 nan 1", "1 1 inf", "1e300 1 1"})
        EXPECT_THAT(message(fmt::format("PVM2\n2 1 1\n{}\n1\nab", spacing)), HasSubstr("long along an axis"))
            << spacing;
    EXPECT_THAT(message("PVM\n2000 2000 2000\n1\n"), HasSubstr("limit is 1000000000"));
    EXPECT_THAT(error_of([] { read("PVM\n3 1 1\n1\nabc", 2); }).message(), HasSubstr("limit is 2"));
}

}  // namespace
}  // namespace shadowbench::scene
