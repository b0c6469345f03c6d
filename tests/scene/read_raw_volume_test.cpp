#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "scene/packed_volume.h"
#include "scene/readers/grid_files.h"
#include "scene/readers/unpacked_bytes.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::bytes_of;
using test::error_of;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(ReadRawVolume, ScalesBytesToTheUnitRange) {
    const auto file = test::write_file("a.raw", std::string("\x00\x33\x66\xff", 4));
    const GridVolume volume = read_raw_volume(file, {2, 1, 2}, "uint8");
    EXPECT_THAT(volume.density, ElementsAre(0.0f, 0.2f, 0.4f, 1.0f));
    EXPECT_EQ(volume.size, Vec3i(2, 1, 2));
}

TEST(ReadRawVolume, ReadsFloatsAsTheyAre) {
    const auto file = test::write_file("a.raw", bytes_of(0.0f, 2.5f, 1e-20f));
    EXPECT_THAT(read_raw_volume(file, {3, 1, 1}, "float32").density, ElementsAre(0.0f, 2.5f, 1e-20f));
}

TEST(ReadRawVolume, RefusesASizeThatIsNotTheFiles) {
    const auto file = test::write_file("a.raw", std::string(24, '\0'));
    EXPECT_NO_THROW(read_raw_volume(file, {2, 3, 4}, "uint8"));
    EXPECT_NO_THROW(read_raw_volume(file, {1, 2, 3}, "float32"));
    for (const Vec3i& size :
         {Vec3i(2, 3, 3), Vec3i(2, 3, 5), Vec3i(24, 24, 24), Vec3i(2147483647, 2147483647, 2147483647)})
        EXPECT_THAT(error_of([&] { read_raw_volume(file, size, "uint8"); }).message(), HasSubstr("24 bytes"));
    EXPECT_EQ(error_of([&] { read_raw_volume(file, {0, 1, 1}, "uint8"); }).code(), base::ErrorCode::bad_input);
    EXPECT_THAT(error_of([&] {
                    read_raw_volume(file, {2, 3, 4}, "int64");
                }).message(),
                HasSubstr("give uint8, int8, uint16, int16, uint32, int32, float16, float32 or float64"));
}

TEST(ReadRawVolume, PointsAtTheByteOfABadDensity) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity}) {
        const auto file = test::write_file("a.raw", bytes_of(0.0f, 1.0f, bad));
        EXPECT_EQ(error_of([&] { read_raw_volume(file, {3, 1, 1}, "float32"); }).where(), file.string() + ": byte 8");
    }
    const auto file = test::write_file("a.raw", bytes_of(0.0f, 1.0f, -1e-6f));
    const base::Error error = error_of([&] { read_raw_volume(file, {3, 1, 1}, "float32", Negative::refuse); });
    EXPECT_EQ(error.where(), file.string() + ": byte 8");
    EXPECT_THAT(error.message(), HasSubstr("below 0"));
}

TEST(ReadRawVolume, TakesDensitiesBelow0As0AndCountsThem) {
    const GridVolume volume =
        read_raw_volume(test::write_file("a.raw", bytes_of(-1e-6f, 1.0f, -3.0f)), {3, 1, 1}, "float32");
    EXPECT_THAT(volume.density, ElementsAre(0.0f, 1.0f, 0.0f));
    EXPECT_THAT(volume.notes.lines, ElementsAre("2 of 3 densities are below 0, the least -3: taken as 0"));
}

TEST(ReadRawVolume, ReadsBigEndianValuesBehindAHeader) {
    RawFormat format;
    format.size = Vec3i(2, 1, 1);
    format.type = ValueType::uint16;
    format.order = ByteOrder::big;
    format.skip = 3;
    const auto file = test::write_file("a.raw", std::string("abc\x01\x02\xff\xff", 7));
    EXPECT_THAT(read_raw_values(file, format, Negative::clamp).density, ElementsAre(258.0f / 65535.0f, 1.0f));
    format.order = ByteOrder::little;
    EXPECT_THAT(read_raw_values(file, format, Negative::clamp).density, ElementsAre(513.0f / 65535.0f, 1.0f));
    for (const std::uint64_t skip : {std::uint64_t{0}, std::uint64_t{2}, std::uint64_t{8}, ~std::uint64_t{0}}) {
        format.skip = skip;
        EXPECT_THAT(error_of([&] { read_raw_values(file, format, Negative::clamp); }).message(),
                    HasSubstr("2 x 1 x 1 values of uint16"))
            << skip;
    }
}

TEST(ReadRawVolume, UnpacksGzip) {
    const std::string values = "head" + bytes_of(0.25, 4.0);
    RawFormat format;
    format.size = Vec3i(1, 2, 1);
    format.type = ValueType::float64;
    format.skip = 4;
    const auto unpacked = [&](const std::string& bytes) {
        return read_raw_values(test::write_file("a.RAW.GZ", test::packed(bytes, 16 + 15)), format, Negative::clamp);
    };
    EXPECT_THAT(unpacked(values).density, ElementsAre(0.25f, 4.0f));
    EXPECT_THAT(error_of([&] { unpacked(values + "a"); }).message(), HasSubstr("more follows the last voxel"));
    EXPECT_THAT(error_of([&] { unpacked(values.substr(0, 19)); }).message(), HasSubstr("too short"));
    // A small file does not take the memory that its size asks for.
    format.size = Vec3i(1000, 1000, 1000);
    EXPECT_THAT(error_of([&] { unpacked(values); }).message(), HasSubstr("cannot hold 8000000004 bytes"));
    format.size = Vec3i(2147483647, 2147483647, 2147483647);
    EXPECT_THAT(error_of([&] { unpacked(values); }).message(), HasSubstr("limit is 1000000000"));
    EXPECT_THAT(error_of([] { gzip_bytes(test::write_file("b.gz", "short")); }).message(), HasSubstr("too short"));
}

TEST(ReadRawVolume, ReadsTheBuckyBall) {
    SHADOWBENCH_NEED_DATA(file, "volumes/bucky_32x32x32_uint8.raw");
    const GridVolume volume = read_raw_volume(file, {32, 32, 32}, "uint8");
    EXPECT_EQ(*std::max_element(volume.density.begin(), volume.density.end()), 1.0f);
    EXPECT_EQ(std::count_if(volume.density.begin(), volume.density.end(), [](float d) { return d > 0.0f; }), 32637);
}

}  // namespace
}  // namespace shadowbench::scene
