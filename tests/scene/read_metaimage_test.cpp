// MetaImage volumes, against values written by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
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
using testing::ElementsAre;
using testing::HasSubstr;

// A whole header; `more` is lines.
std::string header(const std::string& type, const std::string& size, const std::string& more = "",
                   const std::string& data = "LOCAL") {
    return fmt::format("ObjectType = Image\nNDims = 3\nDimSize = {}\n{}ElementType = {}\nElementDataFile = {}\n", size,
                       more, type, data);
}

GridFile read(const std::string& bytes, Negative negative = Negative::clamp) {
    return read_metaimage(test::write_file("a.mha", bytes), negative);
}

std::string message(const std::string& bytes) {
    return test::message_at_byte("a.mha", [&] { read(bytes); });
}

// The offset, 0 where the file has none, is the centre of the first voxel.
TEST(ReadMetaImage, ReadsXFastestAndCentresTheFirstVoxel) {
    const GridFile file = read(header("MET_UCHAR", "3 2 1") + std::string("\x00\x33\x66\x99\xcc\xff", 6));
    EXPECT_EQ(file.volume.size, Vec3i(3, 2, 1));
    EXPECT_THAT(file.volume.density, ElementsAre(0.0f, 0.2f, 0.4f, 0.6f, 0.8f, 1.0f));
    EXPECT_EQ(file.volume.lower, Vec3d(-0.5, -0.5, -0.5));
    EXPECT_EQ(file.volume.upper, Vec3d(2.5, 1.5, 0.5));
    EXPECT_THAT(file.facts, ElementsAre("values of uint8, divided by 255"));
}

TEST(ReadMetaImage, ReadsEveryTypeInBothByteOrders) {
    struct Case {
        const char* type;
        std::string little;  // the bytes of one value
        float density;
    };
    for (const Case& one :
         {Case{"MET_CHAR", bytes_of(std::int8_t{127}), 1.0f}, Case{"MET_UCHAR", bytes_of(std::uint8_t{51}), 0.2f},
          Case{"MET_SHORT", bytes_of(std::int16_t{0x0102}), 258.0f / 32767.0f},
          Case{"MET_USHORT", bytes_of(std::uint16_t{0x0102}), 258.0f / 65535.0f},
          Case{"MET_INT", bytes_of(std::int32_t{1 << 30}), 0.5f},
          Case{"MET_UINT", bytes_of(std::uint32_t{0xffffffffu}), 1.0f},
          Case{"MET_LONG", bytes_of(std::int32_t{1 << 30}), 0.5f},
          Case{"MET_ULONG", bytes_of(std::uint32_t{0xffffffffu}), 1.0f}, Case{"MET_FLOAT", bytes_of(2.5f), 2.5f},
          Case{"MET_DOUBLE", bytes_of(0.25), 0.25f}}) {
        SCOPED_TRACE(one.type);
        const std::string big(one.little.rbegin(), one.little.rend());
        for (const auto& [order, bytes] : {std::pair{"BinaryDataByteOrderMSB = False\n", one.little},
                                           {"ElementByteOrderMSB = false\n", one.little},
                                           {"BinaryDataByteOrderMSB = True\n", big},
                                           {"ElementByteOrderMSB = True\n", big}})
            EXPECT_THAT(read(header(one.type, "1 1 1", order) + bytes).volume.density, ElementsAre(one.density))
                << order;
    }
}

TEST(ReadMetaImage, UnpacksZlib) {
    const std::string values = bytes_of(std::int16_t{0}, std::int16_t{32767}, std::int16_t{-32767});
    const std::string head = header("MET_SHORT", "3 1 1", "CompressedData = True\nCompressedDataSize = 9\n");
    for (const int window : {15, 16 + 15}) {
        const GridFile file = read(head + test::packed(values, window));
        EXPECT_THAT(file.volume.density, ElementsAre(0.0f, 1.0f, 0.0f));
        EXPECT_THAT(file.volume.notes.lines, ElementsAre("1 of 3 densities are below 0, the least -1: taken as 0"));
    }
    EXPECT_THAT(error_of([&] { read(head + test::packed(values, 15), Negative::refuse); }).message(),
                HasSubstr("below 0"));
}

// A gradient along each axis: the density of voxel (i, j, k) of the file is i + 10 j + 100 k.
TEST(ReadMetaImage, PlacesTurnsAndMirrorsTheAxesExactly) {
    std::string values;
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 2; ++i) values += bytes_of(static_cast<float>(i + 10 * j + 100 * k));
    // The file's x runs along -z, its y along x, its z along -y.
    for (const char* matrix : {"TransformMatrix", "Rotation", "Orientation"}) {
        const GridFile file = read(header("MET_FLOAT", "2 3 4",
                                          fmt::format("{} = 0 0 -1 1 0 0 0 -1 0\nOffset = 10 20 30\n"
                                                      "ElementSpacing = 1 2 4\n",
                                                      matrix)) +
                                   values);
        const GridVolume& volume = file.volume;
        EXPECT_EQ(volume.size, Vec3i(3, 4, 2));
        EXPECT_EQ(volume.lower, Vec3d(9, 6, 28.5));
        EXPECT_EQ(volume.upper, Vec3d(15, 22, 30.5));
        EXPECT_THAT(file.facts, ElementsAre(HasSubstr("float32"), "its axes run along -z, x, -y"));
        for (int z = 0; z < 2; ++z)
            for (int y = 0; y < 4; ++y)
                for (int x = 0; x < 3; ++x)
                    EXPECT_EQ(volume.density[static_cast<std::size_t>((z * 4 + y) * 3 + x)],
                              static_cast<float>((1 - z) + 10 * x + 100 * (3 - y)))
                        << x << ", " << y << ", " << z;
    }
}

TEST(ReadMetaImage, HasItsValuesInAnotherFile) {
    test::write_file("values.raw", std::string("head\x33\xff", 6));
    const auto read_beside = [](const std::string& more, const std::string& name) {
        return read_metaimage(test::write_file("a.mhd", header("MET_UCHAR", "2 1 1", more, name)));
    };
    EXPECT_THAT(read_beside("HeaderSize = 4\n", "values.raw").volume.density, ElementsAre(0.2f, 1.0f));
    EXPECT_THAT(read_beside("HeaderSize = -1\n", "values.raw").volume.density, ElementsAre(0.2f, 1.0f));
    const GridFile first = read_beside("", "values.raw");
    EXPECT_THAT(first.volume.density, ElementsAre('h' / 255.0f, 'e' / 255.0f));
    EXPECT_THAT(first.volume.notes.lines, ElementsAre("what follows its last voxel is passed over"));
    for (const char* name : {"../values.raw", "/values.raw"})
        EXPECT_THAT(error_of([&] { read_beside("", name); }).message(), HasSubstr("the folder of the header")) << name;
    EXPECT_EQ(error_of([&] { read_beside("", "gone.raw"); }).code(), base::ErrorCode::no_such_file);
    for (const char* name : {"LIST", "slice%03d.raw 1 2 1"})
        EXPECT_THAT(error_of([&] { read_beside("", name); }).message(), HasSubstr("several files")) << name;
    EXPECT_THAT(error_of([&] { read_beside("HeaderSize = 7\n", "values.raw"); }).message(), HasSubstr("ends before"));
    EXPECT_THAT(error_of([&] { read_beside("HeaderSize = -1\nCompressedData = True\n", "values.raw"); }).message(),
                HasSubstr("without compression alone"));
}

TEST(ReadMetaImage, NamesTheFaultsOfAHeader) {
    EXPECT_THAT(message("nothing\n"), HasSubstr("not a line of a MetaImage header"));
    EXPECT_THAT(message("ObjectType = Tube\nNDims = 3\n"), HasSubstr("not an image"));
    EXPECT_THAT(message("ObjectType = Image\n"), HasSubstr("without the field \"ndims\""));
    EXPECT_THAT(message("NDims = 2\n"), HasSubstr("2 dimensions, where a volume has 3"));
    EXPECT_THAT(message("NDims = 3\nDimSize = 1 1 1\nElementType = MET_UCHAR\n"),
                HasSubstr("without the field \"elementdatafile\""));
    EXPECT_THAT(message(header("MET_LONG_LONG", "1 1 1")), HasSubstr("\"MET_LONG_LONG\""));
    const auto with = [](const std::string& line) { return message(header("MET_UCHAR", "1 1 1", line + "\n") + "a"); };
    EXPECT_THAT(with("NDims = 3"), HasSubstr("there twice"));
    EXPECT_THAT(with("ElementNumberOfChannels = 3"), HasSubstr("several channels"));
    EXPECT_THAT(with("BinaryData = False"), HasSubstr("values in text"));
    EXPECT_THAT(with("BinaryData = perhaps"), HasSubstr("neither True nor False"));
    EXPECT_THAT(with("ElementSpacing = 1 0 1"), HasSubstr("must be above 0"));
    EXPECT_THAT(with("ElementSpacing = 1 1"), HasSubstr("3 numbers are needed"));
    EXPECT_THAT(with("ElementSpacing = 1 1 nan"), HasSubstr("\"nan\" is not a number"));
    EXPECT_THAT(with("ElementSpacing = 1 1 1e-300"), HasSubstr("apart at least"));
    EXPECT_THAT(with("Offset = 1e18 0 0\nElementSpacing = 1e18 1 1"), HasSubstr("from 0"));
    EXPECT_THAT(with("TransformMatrix = 1 0 0 0 1 0"), HasSubstr("9 numbers are needed"));
    EXPECT_THAT(with("TransformMatrix = 1 0 0 0 0 0 0 0 1"), HasSubstr("without length"));
    EXPECT_THAT(with("TransformMatrix = 1 0 0 1 0 0 0 0 1"), HasSubstr("flattens it"));
    EXPECT_EQ(error_of([] { read_metaimage("/nowhere/a.mha"); }).code(), base::ErrorCode::no_such_file);
}

// None of these may take the memory or the time that its header asks for.
TEST(ReadMetaImage, RefusesHostileSizes) {
    EXPECT_THAT(message(header("MET_UCHAR", "1 0 1")), HasSubstr("0 voxels along an axis"));
    EXPECT_THAT(message(header("MET_UCHAR", "4294967297 1 1") + "a"), HasSubstr("4294967297 voxels along an axis"));
    EXPECT_THAT(message(header("MET_UCHAR", "1000000000 1000000000 1000000000")), HasSubstr("limit is 1000000000"));
    EXPECT_THAT(message(header("MET_DOUBLE", "1000 1000 1000")), HasSubstr("too short"));
    EXPECT_THAT(message(header("MET_DOUBLE", "1000 1000 1000", "HeaderSize = -1\n")), HasSubstr("too short"));
    EXPECT_THAT(message(header("MET_DOUBLE", "1000 1000 1000", "CompressedData = True\n") + test::packed("a", 15)),
                HasSubstr("cannot hold 8000000000 bytes"));
    EXPECT_THAT(message(header("MET_UCHAR", "1 1 1", "HeaderSize = 999999999999\n") + "a"), HasSubstr("ends before"));
    EXPECT_THAT(message(std::string(100000, 'x')), HasSubstr("too long for a header"));
}

// A cut or a change may leave the name of a file with the values that is not there: bad input here.
GridVolume read_damaged(const std::filesystem::path& file) {
    try {
        return read_metaimage(file, Negative::clamp, 1 << 16).volume;
    } catch (const base::Error& error) {
        if (error.code() != base::ErrorCode::no_such_file) throw;
        throw base::Error(base::ErrorCode::bad_input, error.where(), error.message());
    }
}

TEST(ReadMetaImage, RefusesAFileCutAnywhere) {
    for (const std::string& bytes :
         {header("MET_UCHAR", "2 2 1") + "abcd",
          header("MET_UCHAR", "2 2 1", "CompressedData = True\n") + test::packed("abcd", 15)})
        test::expect_cuts_refused(bytes, "cut.mha", bytes.size(), [](const auto& file) { read_damaged(file); });
}

TEST(ReadMetaImage, GivesAVolumeOrAnErrorWhateverByteIsChanged) {
    const std::string front = "NDims = 3\nDimSize = 2 2 1\nOffset = 1 2 3\nElementType = MET_UCHAR\n",
                      end = "ElementDataFile = LOCAL\n";
    for (const std::string& bytes :
         {front + end + "abcd", front + "CompressedData = True\n" + end + test::packed("abcd", 15)})
        test::expect_changes_survived(bytes, "changed.mha", read_damaged);
}

}  // namespace
}  // namespace shadowbench::scene
