#include <OpenImageIO/imageio.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "scene/readers/files.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::error_of;
using testing::HasSubstr;

std::filesystem::path write(const std::string& name, int width, int height, int channels,
                            const std::vector<float>& pixels, OIIO::TypeDesc type) {
    const std::filesystem::path file = test::fresh_path(name);
    OIIO::ImageSpec spec(width, height, channels, type);
    const auto output = OIIO::ImageOutput::create(file.string());
    EXPECT_TRUE(output && output->open(file.string(), spec));
    EXPECT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
    output->close();
    return file;
}

TEST(ReadAlpha, TakesTheAlphaChannelRowByRow) {
    const auto file =
        write("a.tif", 2, 2, 4, {1, 1, 1, 0, 1, 1, 1, 0.2f, 0, 0, 0, 0.4f, 0, 0, 0, 1}, OIIO::TypeDesc::FLOAT);
    const AlphaTexture texture = read_alpha(file);
    EXPECT_EQ(texture.width, 2);
    EXPECT_EQ(texture.height, 2);
    EXPECT_THAT(texture.alpha, testing::ElementsAre(0.0f, 0.2f, 0.4f, 1.0f));
}

TEST(ReadAlpha, TakesLuminanceWithoutAlpha) {
    EXPECT_THAT(read_alpha(write("a.tif", 2, 1, 1, {0.25f, 0.75f}, OIIO::TypeDesc::FLOAT)).alpha,
                testing::ElementsAre(0.25f, 0.75f));
    EXPECT_NEAR(read_alpha(write("b.tif", 1, 1, 3, {0, 1, 0}, OIIO::TypeDesc::FLOAT)).alpha[0], 0.7152f, 1e-6f);
}

TEST(ReadAlpha, RefusesAPixelThatIsNoNumber) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto file = write("a.exr", 2, 2, 1, {0, 0, 0, nan}, OIIO::TypeDesc::FLOAT);
    EXPECT_THAT(error_of([&] { read_alpha(file); }).message(), HasSubstr("pixel (1, 1)"));
}

TEST(ReadAlpha, RefusesFilesThatAreNoWholeImage) {
    EXPECT_EQ(error_of([] { read_alpha("/nowhere/a.png"); }).code(), base::ErrorCode::no_such_file);
    std::vector<float> noise(64 * 64);
    for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<float>(i * 7919 % 251) / 251.0f;
    for (const char* name : {"a.tif", "a.exr"}) {
        const std::string bytes = test::read_bytes(write(name, 64, 64, 1, noise, OIIO::TypeDesc::FLOAT));
        test::expect_cuts_refused(bytes, name, bytes.size() / 2, [](const auto& file) { read_alpha(file); });
    }
    EXPECT_EQ(error_of([] { read_alpha(test::write_file("b.png", "no image")); }).code(), base::ErrorCode::bad_input);
}

TEST(ReadAlpha, ReadsTheLeaves) {
    SHADOWBENCH_NEED_DATA(file, "meshes/tree_leaves_alpha.dds");
    const AlphaTexture texture = read_alpha(file);
    EXPECT_EQ(texture.width, 1024);
    EXPECT_EQ(texture.alpha.size(), 1024u * 1024u);
    const double mean = std::accumulate(texture.alpha.begin(), texture.alpha.end(), 0.0) / 1024.0 / 1024.0;
    EXPECT_NEAR(mean, 0.411, 0.001);
}

// A block of 4 x 4 texels whose alpha is 0.
std::string dds_block(const std::string& compression) {
    std::string bytes(128 + 16, '\0');
    bytes.replace(0, 20, "DDS " + test::bytes_of(124, 0x1007, 4, 4));
    bytes.replace(76, 12, test::bytes_of(32, 4) + compression);
    bytes.replace(108, 4, test::bytes_of(0x1000));
    return bytes;
}

// The library divides colours by alpha, as whole numbers.
TEST(ReadAlpha, RefusesADdsWhoseColoursAreMultipliedByAlpha) {
    EXPECT_EQ(read_alpha(test::write_file("straight.dds", dds_block("DXT3"))).alpha, std::vector<float>(16, 0.0f));
    for (const std::string compression : {"DXT2", "DXT4"}) {
        const auto file = test::write_file("multiplied.dds", dds_block(compression));
        EXPECT_THAT(error_of([&] { read_alpha(file); }).message(), HasSubstr("save it as DXT3 or DXT5"));
    }
}

// A file of 4 x 4 pixels of red, green, blue and alpha without compression.
std::string dds_masks(int bits, int red, int green, int blue, int alpha) {
    std::string bytes = dds_block("none").substr(0, 128) + std::string(4 * 4 * 4, '\x33');
    bytes.replace(80, 28, test::bytes_of(0x41, 0, bits, red, green, blue, alpha));
    return bytes;
}

// On a channel of 0 bits the library would never end.
TEST(ReadAlpha, RefusesADdsOfChannelsOrPixelsWithoutBits) {
    constexpr int red = 0xff, green = 0xff00, blue = 0xff0000, alpha = static_cast<int>(0xff000000u);
    const auto read = [](const std::string& bytes) { return read_alpha(test::write_file("masks.dds", bytes)); };
    EXPECT_THAT(read(dds_masks(32, red, green, blue, alpha)).alpha, testing::Each(testing::FloatEq(0.2f)));
    for (const auto& bytes : {dds_masks(32, 0, green, blue, alpha), dds_masks(32, red, 0, blue, alpha),
                              dds_masks(32, red, green, 0, alpha), dds_masks(32, red, green, blue, 0)})
        EXPECT_THAT(error_of([&] { read(bytes); }).message(), HasSubstr("0 bits"));
    for (const int bits : {0, 1, 12, 64, 8192})
        EXPECT_EQ(error_of([&] { read(dds_masks(bits, red, green, blue, alpha)); }).code(), base::ErrorCode::bad_input);
}

TEST(ReadAlpha, RefusesADdsThatEndsInsideItsPixels) {
    SHADOWBENCH_NEED_DATA(file, "meshes/tree_leaves_alpha.dds");
    // DXT3: a byte a texel, behind a header of 128 bytes.
    const std::string bytes = test::read_bytes(file).substr(0, 128 + 1024 * 1024);
    EXPECT_NO_THROW(read_alpha(test::write_file("whole.dds", bytes)));
    const auto cut = test::write_file("cut.dds", bytes.substr(0, bytes.size() - 1));
    EXPECT_EQ(error_of([&] { read_alpha(cut); }).code(), base::ErrorCode::bad_input);
}

}  // namespace
}  // namespace shadowbench::scene
