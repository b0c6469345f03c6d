#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scene/readers/files.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::bytes_of;
using test::error_of;
using testing::HasSubstr;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// Two strands of two points; the second has no length.
std::string version_3(float last = 8.0f) {
    std::string bytes = bytes_of(3.0f, 2u, 2u);
    bytes.resize(296, '\0');
    return bytes + bytes_of(0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f, 8.0f, 6.0f, 7.0f, last);
}

std::string version_4(std::uint32_t offset) {
    std::string bytes = bytes_of(4.0f, 1u, 2u, offset);
    bytes.resize(offset, '\0');
    return bytes + bytes_of(1.0f, 2.0f, 3.0f, 0.0f, 4.0f, 5.0f, 6.0f, 1.0f);
}

TEST(ReadTressfx, ReadsVersion3) {
    const Hair hair = read_tressfx(test::write_file("a.tfx", version_3()), 0.25f);
    EXPECT_THAT(hair.points, testing::ElementsAre(Vec3f(0, 1, 2), Vec3f(3, 4, 5), Vec3f(6, 7, 8), Vec3f(6, 7, 8)));
    EXPECT_THAT(hair.radii, testing::ElementsAre(0.25f, 0.25f, 0.25f, 0.25f));
    EXPECT_THAT(hair.strand_begin, testing::ElementsAre(0u, 2u, 4u));
}

TEST(ReadTressfx, ReadsVersion4WithoutItsInverseMasses) {
    for (const std::uint32_t offset : {160u, 200u}) {
        const Hair hair = read_tressfx(test::write_file("a.tfx", version_4(offset)), 0.0f);
        EXPECT_THAT(hair.points, testing::ElementsAre(Vec3f(1, 2, 3), Vec3f(4, 5, 6)));
        EXPECT_THAT(hair.radii, testing::ElementsAre(0.0f, 0.0f));
    }
}

TEST(ReadTressfx, RefusesAFileCutAnywhere) {
    const auto read = [](const std::filesystem::path& file) { read_tressfx(file, 1.0f); };
    test::expect_cuts_refused(version_3(), "cut.tfx", version_3().size(), read);
    test::expect_cuts_refused(version_4(160), "cut.tfx", version_4(160).size(), read);
}

TEST(ReadTressfx, PointsAtTheByteOfAPositionThatIsNoNumber) {
    for (const float bad : {nan, std::numeric_limits<float>::infinity(), 1e30f}) {
        const std::filesystem::path file = test::write_file("a.tfx", version_3(bad));
        const base::Error error = error_of([&] { read_tressfx(file, 1.0f); });
        EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
        EXPECT_EQ(error.where(), file.string() + ": byte 340");
    }
}

TEST(ReadTressfx, RefusesHeadersThatCannotBe) {
    const auto refused = [](const std::string& bytes) {
        return error_of([&] { read_tressfx(test::write_file("a.tfx", bytes), 1.0f); }).message();
    };
    const std::string rest(1000, '\0');
    EXPECT_THAT(refused(bytes_of(2.0f, 2u, 2u) + rest), HasSubstr("version 2"));
    EXPECT_THAT(refused(bytes_of(nan, 2u, 2u) + rest), HasSubstr("versions 3 and 4"));
    EXPECT_THAT(refused(bytes_of(3.0f, 2u, 1u) + rest), HasSubstr("1 points each"));
    // The counts suffice to refuse it: neither the file nor memory holds 2^64 bytes.
    EXPECT_THAT(refused(bytes_of(3.0f, 0xffffffffu, 0xffffffffu) + rest), HasSubstr("limit is 200000000"));
    EXPECT_THAT(refused(bytes_of(3.0f, 10000000u, 16u) + rest), HasSubstr("too short"));
    EXPECT_THAT(refused(bytes_of(4.0f, 2u, 2u, 12u) + rest), HasSubstr("overlap the header"));
}

TEST(ReadTressfx, DistinguishesAMissingFileFromADamagedOne) {
    EXPECT_EQ(error_of([] { read_tressfx("/nowhere/a.tfx", 1.0f); }).code(), base::ErrorCode::no_such_file);
}

TEST(ReadTressfx, ReadsTheBear) {
    SHADOWBENCH_NEED_DATA(file, "hair/bear.tfx");
    const Hair hair = read_tressfx(file, 0.1f);
    EXPECT_EQ(hair.strand_begin.size(), 48113u + 1);
    EXPECT_EQ(hair.points.size(), 48113u * 4);
    EXPECT_EQ(hair.strand_begin.back(), hair.points.size());
    // Extreme coordinates, found by reading the file with a script.
    float highest = 0.0f;
    for (const Vec3f& point : hair.points) highest = std::max(highest, point.y);
    EXPECT_FLOAT_EQ(highest, 114.10978f);
}

}  // namespace
}  // namespace shadowbench::scene
