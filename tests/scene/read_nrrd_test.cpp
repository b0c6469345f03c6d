// NRRD volumes, against values written by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "scene/packed_volume.h"
#include "scene/readers/grid_files.h"
#include "scene/refusal.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::bytes_of;
using test::error_of;
using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

// A header up to its empty line. `more` is lines.
std::string header(const std::string& type, const std::string& sizes, const std::string& more = "",
                   const std::string& encoding = "raw") {
    return fmt::format("NRRD0004\n# a comment\ntype: {}\ndimension: 3\nsizes: {}\nencoding: {}\n{}\n", type, sizes,
                       encoding, more);
}

GridFile read(const std::string& bytes, Negative negative = Negative::clamp, std::uint64_t most = max_voxels) {
    return read_nrrd(test::write_file("a.nrrd", bytes), negative, most);
}

std::string message(const std::string& bytes) {
    return test::message_at_byte("a.nrrd", [&] { read(bytes); });
}

TEST(ReadNrrd, ReadsXFastestWithVoxelsOfEdge1AtTheOrigin) {
    const GridFile file = read(header("uchar", "3 2 1") + std::string("\x00\x33\x66\x99\xcc\xff", 6));
    EXPECT_EQ(file.volume.size, Vec3i(3, 2, 1));
    EXPECT_THAT(file.volume.density, ElementsAre(0.0f, 0.2f, 0.4f, 0.6f, 0.8f, 1.0f));
    EXPECT_EQ(file.volume.lower, Vec3d(0, 0, 0));
    EXPECT_EQ(file.volume.upper, Vec3d(3, 2, 1));
    EXPECT_THAT(file.facts, ElementsAre("values of uint8, divided by 255"));
    EXPECT_TRUE(file.volume.notes.lines.empty());
}

// A value with the wrong width, sign or byte order would give another density.
TEST(ReadNrrd, ReadsEveryTypeInBothByteOrders) {
    struct Case {
        const char* type;
        std::string little;  // the bytes of one value
        float density;
    };
    for (const Case& one :
         {Case{"signed char", bytes_of(std::int8_t{127}), 1.0f},
          Case{"unsigned char", bytes_of(std::uint8_t{51}), 0.2f},
          Case{"short", bytes_of(std::int16_t{0x0102}), 258.0f / 32767.0f},
          Case{"unsigned short", bytes_of(std::uint16_t{0x0102}), 258.0f / 65535.0f},
          Case{"uint16", bytes_of(std::uint16_t{65535}), 1.0f}, Case{"int", bytes_of(std::int32_t{2147483647}), 1.0f},
          Case{"int32_t", bytes_of(std::int32_t{1 << 30}), 0.5f},
          Case{"unsigned int", bytes_of(std::uint32_t{0xffffffffu}), 1.0f}, Case{"float", bytes_of(2.5f), 2.5f},
          Case{"double", bytes_of(1e-20), 1e-20f}}) {
        SCOPED_TRACE(one.type);
        const std::string big(one.little.rbegin(), one.little.rend());
        for (const auto& [endian, bytes] : {std::pair{"little", one.little}, {"big", big}}) {
            const GridFile file = read(header(one.type, "1 1 1", fmt::format("endian: {}\n", endian)) + bytes);
            EXPECT_THAT(file.volume.density, ElementsAre(one.density)) << endian;
        }
    }
}

TEST(ReadNrrd, UnpacksGzipOfSeveralMembers) {
    const std::string values = bytes_of(std::int16_t{0}, std::int16_t{32767}, std::int16_t{-32767}),
                      head = header("short", "3 1 1", "endian: little\n", "gzip");
    for (const std::string& bytes :
         {test::packed(values, 16 + 15), test::packed(values.substr(0, 3), 16 + 15) + test::packed("", 16 + 15) +
                                             test::packed(values.substr(3), 16 + 15)}) {
        const GridFile file = read(head + bytes);
        EXPECT_THAT(file.volume.density, ElementsAre(0.0f, 1.0f, 0.0f));
        EXPECT_THAT(file.volume.notes.lines, ElementsAre("1 of 3 densities are below 0, the least -1: taken as 0"));
        EXPECT_THAT(file.facts, ElementsAre("values of int16, little-endian, packed, divided by 32767"));
    }
    EXPECT_THAT(error_of([&] { read(head + test::packed(values, 16 + 15), Negative::refuse); }).message(),
                AllOf(HasSubstr("byte 4 of what begins here"), HasSubstr("below 0")));
}

TEST(ReadNrrd, TakesSpacingsAndLeavesOpenOnesAt1) {
    const GridFile file = read(header("uchar", "1 2 4", "spacings: 0.5 2 nan\n") + "abcdefgh");
    EXPECT_EQ(file.volume.lower, Vec3d(0, 0, 0));
    EXPECT_EQ(file.volume.upper, Vec3d(0.5, 4, 4));
}

// The origin of an oriented grid is the centre of its first voxel.
TEST(ReadNrrd, PlacesAnOrientedGrid) {
    const GridFile file = read(header("uchar", "2 3 4",
                                      "space: left-posterior-superior\nspace units: \"mm\" \"mm\" \"mm\"\n"
                                      "space directions: (0.5,0,0) (0,1,0) (0,0,2)\nspace origin: (10,20,30)\n") +
                               std::string(24, 'a'));
    EXPECT_EQ(file.volume.lower, Vec3d(9.75, 19.5, 29));
    EXPECT_EQ(file.volume.upper, Vec3d(10.75, 22.5, 37));
    EXPECT_THAT(file.facts,
                ElementsAre(HasSubstr("uint8"), "space: left-posterior-superior", "space units: \"mm\" \"mm\" \"mm\""));
}

// A gradient along each axis: the density of voxel (i, j, k) of the file is i + 10 j + 100 k.
TEST(ReadNrrd, TurnsAndMirrorsTheAxesExactly) {
    std::string values;
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 2; ++i) values += bytes_of(static_cast<float>(i + 10 * j + 100 * k));
    // The file's x runs along -z, its y along x, its z along -y.
    const GridVolume volume = read(header("float", "2 3 4",
                                          "endian: little\nspace dimension: 3\n"
                                          "space directions: (0,0,-1) (2,0,0) (0,-4,0)\nspace origin: (0,0,0)\n") +
                                   values)
                                  .volume;
    EXPECT_EQ(volume.size, Vec3i(3, 4, 2));
    EXPECT_EQ(volume.lower, Vec3d(-1, -14, -1.5));
    EXPECT_EQ(volume.upper, Vec3d(5, 2, 0.5));
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 3; ++x) {
                const int i = 1 - z, j = x, k = 3 - y;
                EXPECT_EQ(volume.density[static_cast<std::size_t>((z * 4 + y) * 3 + x)],
                          static_cast<float>(i + 10 * j + 100 * k))
                    << x << ", " << y << ", " << z;
            }
}

TEST(ReadNrrd, LeavesOutAxesOfOneValue) {
    const std::string lines = "NRRD0005\ntype: uchar\nencoding: raw\n";
    const GridFile file = read(lines +
                               "dimension: 4\nsizes: 1 2 1 1\n"
                               "space directions: none (1,0,0) (0,1,0) (0,0,3)\n\nab");
    EXPECT_EQ(file.volume.size, Vec3i(2, 1, 1));
    EXPECT_EQ(file.volume.upper, Vec3d(2, 1, 3));
    EXPECT_THAT(message(lines + "dimension: 4\nsizes: 3 2 2 2\n\nabcdefghijkl"), HasSubstr("unu slice"));
    EXPECT_THAT(message(lines + "dimension: 2\nsizes: 2 2\n\nabcd"), HasSubstr("2 dimensions"));
    EXPECT_THAT(message(lines + "dimension: 99\nsizes: 2 2\n\nabcd"), HasSubstr("99 dimensions"));
}

// A coloured picture would be read as a volume of three slices.
TEST(ReadNrrd, RefusesAxesThatAreNotPlaces) {
    EXPECT_THAT(message(header("uchar", "3 1 1", "kinds: RGB-color domain domain\n") + "abc"),
                AllOf(HasSubstr("axis 0"), HasSubstr("rgb-color"), HasSubstr("unu slice")));
    EXPECT_NO_THROW(read(header("uchar", "3 1 1", "kinds: space domain list\n") + "abc"));
    EXPECT_NO_THROW(read(header("uchar", "3 1 1", "kinds: none ??? time\n") + "abc"));
    // Such an axis of one value is left out.
    EXPECT_NO_THROW(read("NRRD0004\ntype: uchar\nencoding: raw\ndimension: 4\nsizes: 1 3 1 2\n"
                         "kinds: vector space space space\n\nabcdef"));
}

TEST(ReadNrrd, SkipsLinesAndBytes) {
    for (const auto& [skip, front] : {std::pair{"byte skip: 3\n", "xyz"},
                                      {"line skip: 2\n", "one\ntwo\n"},
                                      {"lineskip: 1\nbyteskip: 2\n", "one\nxy"},
                                      {"byte skip: -1\n", "whatever"}})
        EXPECT_THAT(read(header("uchar", "2 1 1", skip) + front + "\x33\xff").volume.density, ElementsAre(0.2f, 1.0f))
            << skip;
    EXPECT_THAT(
        read(header("uchar", "2 1 1", "byte skip: 3\n", "gzip") + test::packed("xyz\x33\xff", 16 + 15)).volume.density,
        ElementsAre(0.2f, 1.0f));
    EXPECT_THAT(message(header("uchar", "2 1 1", "line skip: 3\n") + "one\n"), HasSubstr("fewer than 3 lines"));
    EXPECT_THAT(message(header("uchar", "2 1 1", "byte skip: -1\n", "gzip")), HasSubstr("raw values alone"));
    EXPECT_THAT(message(header("uchar", "2 1 1", "byte skip: -1\n") + "a"), HasSubstr("too short"));
    EXPECT_THAT(message(header("uchar", "2 1 1", "byte skip: 999999999999999999\n") + "a"), HasSubstr("too short"));
    EXPECT_THAT(message(header("uchar", "2 1 1", "byte skip: -2\n") + "ab"), HasSubstr("-2 is not from -1"));
}

TEST(ReadNrrd, NotesWhatItPassesOver) {
    EXPECT_THAT(read(header("uchar", "2 1 1", "axis mins: 1 1 1\naxis maxs: 2 2 2\n") + "ab").volume.notes.lines,
                ElementsAre(HasSubstr("axis mins and maxs are passed over")));
    EXPECT_THAT(read(header("uchar", "2 1 1") + "abc").volume.notes.lines,
                ElementsAre("what follows its last voxel is passed over"));
}

class NrrdHeader : public testing::Test {
protected:
    // Writes a header beside "values.raw".
    std::filesystem::path with_data(const std::string& name) {
        test::write_file("values.raw", "\x33\xff");
        return test::write_file("a.nhdr", header("uchar", "2 1 1", "data file: " + name + "\n"));
    }
};

TEST_F(NrrdHeader, HasItsValuesInAnotherFile) {
    EXPECT_THAT(read_nrrd(with_data("values.raw")).volume.density, ElementsAre(0.2f, 1.0f));
    EXPECT_THAT(read_nrrd(with_data("./values.raw")).volume.density, ElementsAre(0.2f, 1.0f));
    // The header may end with the file.
    const auto no_empty_line = test::write_file(
        "b.nhdr", "NRRD0001\r\ntype: uint8\r\ndimension: 3\r\nsizes: 2 1 1\r\nencoding: raw\r\ndatafile: values.raw");
    EXPECT_THAT(read_nrrd(no_empty_line).volume.density, ElementsAre(0.2f, 1.0f));
}

// A header that a server reads must not show what other folders hold.
TEST_F(NrrdHeader, ReachesNoOtherFolder) {
    namespace fs = std::filesystem;
    const fs::path folder = test::write_file("values.raw", "ab").parent_path();
    fs::create_directories(folder / "inner");
    fs::remove(folder / "inner/link.raw");
    fs::create_symlink(folder / "values.raw", folder / "inner/link.raw");
    const auto refused = [&](const std::string& name) {
        const auto file = test::write_file("inner/a.nhdr", header("uchar", "2 1 1", "data file: " + name + "\n"));
        const base::Error error = error_of([&] { read_nrrd(file); });
        EXPECT_EQ(error.code(), base::ErrorCode::bad_input) << name;
        EXPECT_THAT(error.message(), HasSubstr("the folder of the header")) << name;
    };
    refused("../values.raw");
    refused("x/../../values.raw");
    refused((folder / "values.raw").string());
    refused("link.raw");
    refused("");
    const base::Error missing = error_of([&] { read_nrrd(with_data("gone.raw")); });
    EXPECT_EQ(missing.code(), base::ErrorCode::no_such_file);
    EXPECT_THAT(missing.where(), HasSubstr("a.nhdr: byte "));
    EXPECT_THAT(missing.message(), HasSubstr("\"gone.raw\""));
    for (const char* several : {"LIST\na.raw\nb.raw", "slice%03d.raw 1 2 1"})
        EXPECT_THAT(error_of([&] { read_nrrd(with_data(several)); }).message(), HasSubstr("unu save"));
}

TEST(ReadNrrd, NamesTheFaultsOfAHeader) {
    EXPECT_THAT(message("NRRD0009\n\n"), HasSubstr("not an NRRD file"));
    EXPECT_THAT(message(""), HasSubstr("not an NRRD file"));
    EXPECT_THAT(message("NRRD0004\nnothing\n\n"), HasSubstr("gives no field a value"));
    EXPECT_THAT(message("NRRD0004\ntype: uchar\ntype: uchar\n\n"), HasSubstr("\"type\" is there twice"));
    EXPECT_THAT(message("NRRD0004\ndimension: 3\n\n"), HasSubstr("without the field \"sizes\""));
    EXPECT_THAT(message(header("int64", "1 1 1")), AllOf(HasSubstr("\"int64\""), HasSubstr("unu convert")));
    EXPECT_THAT(message(header("short", "1 1 1") + "ab"), HasSubstr("without the field \"endian\""));
    EXPECT_THAT(message(header("short", "1 1 1", "endian: middle\n") + "ab"), HasSubstr("neither little nor big"));
    for (const char* encoding : {"ascii", "text", "hex", "bzip2"})
        EXPECT_THAT(message(header("uchar", "1 1 1", "", encoding) + "1"),
                    AllOf(HasSubstr(encoding), HasSubstr("raw and gzip are read")));
    EXPECT_THAT(message(header("uchar", "1 1")), HasSubstr("3 whole numbers are needed"));
    EXPECT_THAT(message(header("uchar", "1 1 1 1")), HasSubstr("3 whole numbers are needed"));
    EXPECT_THAT(message(header("uchar", "1 1.5 1")), HasSubstr("\"1.5\" is not a whole number"));
    for (const char* spacings : {"0 1 1", "1 -1 1", "1 1 inf", "1 1", "1 1 1e300"})
        EXPECT_THAT(message(header("uchar", "1 1 1", fmt::format("spacings: {}\n", spacings)) + "a"),
                    HasSubstr("needs a spacing above 0"))
            << spacings;
    const auto directed = [](const std::string& vectors) {
        return message(header("uchar", "1 1 1", "space directions: " + vectors + "\n") + "a");
    };
    EXPECT_THAT(directed("(1,0,0) (0,1,0)"), HasSubstr("vectors of three numbers"));
    EXPECT_THAT(directed("(1,0) (0,1,0) (0,0,1)"), HasSubstr("vectors of three numbers"));
    EXPECT_THAT(directed("(1,0,0,0) (0,1,0) (0,0,1)"), HasSubstr("vectors of three numbers"));
    EXPECT_THAT(directed("(1,0,0) (0,1,0) (0,0,1) (0,0,1)"), HasSubstr("more than 3 vectors"));
    EXPECT_THAT(directed("(1,0,0) none (0,0,1)"), HasSubstr("has no direction"));
    EXPECT_THAT(directed("(1,0,0) (0,0,0) (0,0,1)"), HasSubstr("without length"));
    EXPECT_THAT(directed("(1,0,nan) (0,1,0) (0,0,1)"), HasSubstr("vectors of three numbers"));
    EXPECT_THAT(directed("(1,0,0) (0,1,0) (0,0,1e-300)"), HasSubstr("apart at least"));
    EXPECT_THAT(directed("(1,0,0) (1,0,0) (0,0,1)"), HasSubstr("flattens it"));
    EXPECT_EQ(error_of([] { read_nrrd("/nowhere/a.nrrd"); }).code(), base::ErrorCode::no_such_file);
}

// Scanners write such directions. Without the turn the box would be 2 x 2 x 1 voxels along the axes.
TEST(ReadNrrd, KeepsTheVoxelsOfATurnedGrid) {
    const std::string turned = "space directions: (3,4,0) (-4,3,0) (0,0,5)\n", four("\x33\x66\x99\xff", 4);
    const GridFile file = read(header("uchar", "2 2 1", turned + "space origin: (10,20,30)\n") + four);
    const GridVolume& volume = file.volume;
    EXPECT_THAT(file.facts, testing::Contains("its axes run along (0.6, 0.8, 0), (-0.8, 0.6, 0), (0, 0, 1)"));
    EXPECT_EQ(volume.size, Vec3i(2, 2, 1));
    EXPECT_THAT(volume.density, ElementsAre(0.2f, 0.4f, 0.6f, 1.0f));
    EXPECT_TRUE(volume.notes.lines.empty());
    EXPECT_EQ(volume.upper - volume.lower, Vec3d(10, 10, 5)) << "edges of voxels as in the world";
    ASSERT_TRUE(volume.frame);
    const auto expect_at = [&](const Vec3d& own, const Vec3d& world) {
        const Vec3d at = base::map_point(volume.frame->to_world, own);
        for (int a = 0; a < 3; ++a) EXPECT_NEAR(at[a], world[a], 1e-12);
    };
    expect_at(volume.lower + Vec3d(2.5, 2.5, 2.5), Vec3d(10, 20, 30));
    expect_at(volume.lower + Vec3d(7.5, 2.5, 2.5), Vec3d(13, 24, 30));
    expect_at(volume.lower + Vec3d(2.5, 7.5, 2.5), Vec3d(6, 23, 30));
    // Without an origin the box around it begins at the world's.
    const Box3d unplaced = world_box(read(header("uchar", "2 2 1", turned) + four).volume);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(unplaced.min[a], 0.0, 1e-12);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(unplaced.max[a], a == 2 ? 5.0 : 14.0, 1e-12);
}

// None of these may take the memory or the time that its header asks for.
TEST(ReadNrrd, RefusesHostileSizes) {
    EXPECT_THAT(message(header("uchar", "0 1 1")), HasSubstr("0 voxels along an axis"));
    EXPECT_THAT(message(header("uchar", "-1 -1 1") + "a"), HasSubstr("-1 voxels along an axis"));
    EXPECT_THAT(message(header("uchar", "99999999999999999999 1 1")), HasSubstr("not a whole number"));
    EXPECT_THAT(message(header("uchar", "4294967297 1 1") + "a"), HasSubstr("4294967297 voxels along an axis"));
    EXPECT_THAT(message(header("uchar", "2000 2000 2000")), HasSubstr("limit is 1000000000"));
    EXPECT_THAT(message(header("uchar", "1000000000 1000000000 1000000000")), HasSubstr("limit is 1000000000"));
    EXPECT_THAT(message(header("double", "1000 1000 1000", "endian: big\n") + "a"), HasSubstr("too short"));
    EXPECT_THAT(message(header("double", "1000 1000 1000", "endian: big\n", "gzip") + test::packed("a", 16 + 15)),
                HasSubstr("cannot hold 8000000000 bytes"));
    EXPECT_THAT(error_of([] { read(header("uchar", "3 1 1") + "abc", Negative::clamp, 2); }).message(),
                HasSubstr("limit is 2"));
    EXPECT_THAT(message("NRRD0004\n#" + std::string(100000, 'x')), HasSubstr("too long for a header"));
    std::string endless = "NRRD0004\n";
    while (endless.size() < (1u << 20) + 5000) endless += "#" + std::string(1000, 'x') + "\n";
    EXPECT_THAT(message(endless), HasSubstr("its end is missing"));
}

TEST(ReadNrrd, RefusesDamagedPacking) {
    const std::string head = header("uchar", "4 1 1", "", "gzip"), packed = test::packed("abcd", 16 + 15);
    EXPECT_THAT(read(head + packed).volume.density, testing::SizeIs(4));
    EXPECT_THAT(message(head + "abcdefgh"), HasSubstr("neither gzip nor zlib"));
    EXPECT_THAT(message(head + test::packed("abc", 16 + 15)), HasSubstr("4 bytes of voxels should follow, and 3 do"));
    std::string wrong_sum = packed;
    wrong_sum[wrong_sum.size() - 8] = static_cast<char>(wrong_sum[wrong_sum.size() - 8] ^ 1);
    EXPECT_THAT(message(head + wrong_sum), HasSubstr("damaged"));
    test::expect_cuts_refused(head + packed, "cut.nrrd", head.size() + packed.size(),
                              [](const auto& file) { read_nrrd(file); });
}

TEST(ReadNrrd, RefusesDensitiesThatAreNotFinite) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity, 1e30f}) {
        const std::string head = header("float", "2 1 1", "endian: little\n");
        const base::Error error = error_of([&] { read(head + bytes_of(1.0f, bad)); });
        EXPECT_THAT(error.where(), HasSubstr(fmt::format("byte {}", head.size() + 4)));
        EXPECT_THAT(error.message(), HasSubstr("not a finite number"));
    }
}

TEST(ReadNrrd, GivesAVolumeOrAnErrorWhateverByteIsChanged) {
    const std::string lines = "spacings: 1 2 3\n";
    for (const std::string& bytes : {header("uchar", "2 2 1", lines) + "abcd",
                                     header("uchar", "2 2 1", lines, "gzip") + test::packed("abcd", 16 + 15)})
        test::expect_changes_survived(
            bytes, "changed.nrrd", [](const auto& file) { return read_nrrd(file, Negative::clamp, 1 << 16).volume; });
}

TEST(ReadNrrd, KeepsAConstantBoxConstant) {
    std::string values;
    for (int i = 0; i < 70000; ++i) values += bytes_of(std::uint16_t{32768});  // more than is read at once
    const GridVolume volume = read(header("ushort", "70 100 10", "endian: little\n") + values).volume;
    EXPECT_EQ(volume.density.size(), 70000u);
    EXPECT_THAT(volume.density, Each(32768.0f / 65535.0f));
}

}  // namespace
}  // namespace shadowbench::scene
