#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "scene/readers/files.h"
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
    EXPECT_THAT(error_of([&] { read_raw_volume(file, {2, 3, 4}, "int16"); }).message(), HasSubstr("uint8 or float32"));
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

TEST(ReadRawVolume, ReadsTheBuckyBall) {
    SHADOWBENCH_NEED_DATA(file, "volumes/bucky_32x32x32_uint8.raw");
    const GridVolume volume = read_raw_volume(file, {32, 32, 32}, "uint8");
    EXPECT_EQ(*std::max_element(volume.density.begin(), volume.density.end()), 1.0f);
    EXPECT_EQ(std::count_if(volume.density.begin(), volume.density.end(), [](float d) { return d > 0.0f; }), 32637);
}

}  // namespace
}  // namespace shadowbench::scene
