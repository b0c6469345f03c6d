#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "scene/files.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::error_of;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

struct Sample {
    std::vector<float> values;  // one a channel
};

// 2 x 1 pixels: the first empty, the second with these samples.
std::filesystem::path write(const std::vector<std::string>& channels, const std::vector<Sample>& samples,
                            int tile = 0) {
    const std::filesystem::path file = test::fresh_path("a.exr");
    OIIO::ImageSpec spec(2, 1, static_cast<int>(channels.size()), OIIO::TypeDesc::FLOAT);
    spec.deep = true;
    spec.channelnames = channels;
    if (tile > 0) spec.tile_width = spec.tile_height = tile;
    OIIO::DeepData data;
    data.init(spec);
    data.set_samples(1, static_cast<int>(samples.size()));
    for (std::size_t s = 0; s < samples.size(); ++s)
        for (std::size_t c = 0; c < channels.size(); ++c)
            data.set_deep_value(1, static_cast<int>(c), static_cast<int>(s), samples[s].values[c]);
    const auto output = OIIO::ImageOutput::create(file.string());
    EXPECT_TRUE(output && output->open(file.string(), spec));
    EXPECT_TRUE(output->write_deep_image(data)) << output->geterror();
    output->close();
    return file;
}

TEST(ReadDeepImage, MapsChannelsByNameAndSortsByDepth) {
    const DeepImage image =
        read_deep_image(write({"R", "ZBack", "Z", "A"}, {{{9, 3.5f, 3, 0.25f}}, {{9, 1.5f, 1, 1}}, {{9, 2, 2, 0}}}));
    EXPECT_EQ(image.width, 2);
    EXPECT_EQ(image.height, 1);
    EXPECT_THAT(image.begin, ElementsAre(0u, 0u, 3u));
    EXPECT_THAT(image.z_front, ElementsAre(1, 2, 3));
    EXPECT_THAT(image.z_back, ElementsAre(1.5f, 2, 3.5f));
    EXPECT_THAT(image.transmittance, ElementsAre(0, 1, 0.75f));
}

TEST(ReadDeepImage, SamplesAreSurfacesWithoutZBack) {
    const DeepImage image = read_deep_image(write({"A", "Z"}, {{{0.5f, 4}}}));
    EXPECT_EQ(image.z_back, image.z_front);
}

TEST(ReadDeepImage, ReadsTiles) {
    EXPECT_THAT(read_deep_image(write({"A", "Z"}, {{{0.5f, 4}}}, 16)).z_front, ElementsAre(4));
}

TEST(ReadDeepImage, ClampsAlphaThatIsOutsideByRounding) {
    const DeepImage image = read_deep_image(write({"A", "Z"}, {{{1.001f, 1}}, {{-0.001f, 2}}}));
    EXPECT_THAT(image.transmittance, ElementsAre(0, 1));
}

TEST(ReadDeepImage, TellsThePixelOfABadSample) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    const auto message = [](const Sample& sample) {
        return error_of([&] { read_deep_image(write({"A", "Z", "ZBack"}, {{{0.5f, 1, 1}}, sample})); }).message();
    };
    const auto pixel = HasSubstr("pixel (1, 0), sample 1");
    EXPECT_THAT(message({{nan, 1, 1}}), AllOf(pixel, HasSubstr("not finite")));
    EXPECT_THAT(message({{0.5f, infinity, infinity}}), AllOf(pixel, HasSubstr("not finite")));
    EXPECT_THAT(message({{0.5f, 2, nan}}), AllOf(pixel, HasSubstr("not finite")));
    EXPECT_THAT(message({{0.5f, 2, 1}}), AllOf(pixel, HasSubstr("before Z")));
    EXPECT_THAT(message({{2, 1, 1}}), AllOf(pixel, HasSubstr("alpha 2")));
    EXPECT_THAT(message({{-1, 1, 1}}), AllOf(pixel, HasSubstr("alpha -1")));
}

TEST(ReadDeepImage, NamesTheChannelsWhenOneIsMissing) {
    EXPECT_THAT(error_of([] {
                    read_deep_image(write({"A", "depth"}, {{{0.5f, 4}}}));
                }).message(),
                HasSubstr("A, depth"));
}

TEST(ReadDeepImage, RefusesMipLevelsBeforePixelsAreRead) {
    // The library cannot write such a file: the level mode in the header of a tiled one is changed by hand. A "tiles"
    // attribute is its name, its type, its size, x size, y size, mode.
    std::string bytes = test::read_bytes(write({"A", "Z"}, {{{0.5f, 4}}}, 16));
    const std::string mark("tiles\0tiledesc\0\x09\0\0\0", 19);
    const std::size_t at = bytes.find(mark);
    ASSERT_NE(at, std::string::npos);
    ASSERT_EQ(bytes[at + mark.size() + 8], 0);
    bytes[at + mark.size() + 8] = 1;
    const auto file = test::write_file("mip.exr", bytes);
    const base::Error error = error_of([&] { read_deep_image(file); });
    EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
    EXPECT_THAT(error.message(), HasSubstr("mip levels"));
}

TEST(ReadDeepImage, RefusesOtherFiles) {
    const std::filesystem::path flat = test::fresh_path("flat.exr");
    const auto output = OIIO::ImageOutput::create(flat.string());
    const std::vector<float> pixels(2 * 2 * 2, 0.5f);
    ASSERT_TRUE(output->open(flat.string(), OIIO::ImageSpec(2, 2, 2, OIIO::TypeDesc::FLOAT)));
    output->write_image(OIIO::TypeDesc::FLOAT, pixels.data());
    output->close();
    EXPECT_THAT(error_of([&] { read_deep_image(flat); }).message(), HasSubstr("not a deep image"));
    EXPECT_EQ(error_of([] { read_deep_image(test::write_file("x.exr", "no image")); }).code(),
              base::ErrorCode::bad_input);
    EXPECT_EQ(error_of([] { read_deep_image("/nowhere/a.exr"); }).code(), base::ErrorCode::no_such_file);
}

TEST(ReadDeepImage, RefusesAFileCutAnywhere) {
    const std::string bytes = test::read_bytes(write({"A", "Z"}, {{{0.5f, 4}}, {{0.5f, 5}}}));
    test::expect_cuts_refused(bytes, "cut.exr", bytes.size(), [](const auto& file) { read_deep_image(file); });
    for (const std::size_t length : {std::size_t{0}, std::size_t{100}, bytes.size() - 1}) {
        const auto file = test::write_file("cut.exr", bytes.substr(0, length));
        // The place names the file already.
        EXPECT_THAT(error_of([&] { read_deep_image(file); }).message(), testing::Not(HasSubstr(file.string())));
    }
}

struct Real {
    const char* name;
    int width, height;
    std::size_t samples, most;
};

class ReadRealDeepImage : public testing::TestWithParam<Real> {};

TEST_P(ReadRealDeepImage, HasItsSamplesSorted) {
    SHADOWBENCH_NEED_DATA(file, GetParam().name);
    const DeepImage image = read_deep_image(file);
    EXPECT_EQ(image.width, GetParam().width);
    EXPECT_EQ(image.height, GetParam().height);
    EXPECT_EQ(image.z_front.size(), GetParam().samples);
    ASSERT_EQ(image.begin.back(), GetParam().samples);
    std::size_t most = 0;
    for (std::size_t i = 0; i + 1 < image.begin.size(); ++i) {
        most = std::max<std::size_t>(most, image.begin[i + 1] - image.begin[i]);
        const auto from = image.z_front.begin() + static_cast<std::ptrdiff_t>(image.begin[i]);
        ASSERT_TRUE(std::is_sorted(from, image.z_front.begin() + static_cast<std::ptrdiff_t>(image.begin[i + 1])));
    }
    EXPECT_EQ(most, GetParam().most);
}

INSTANTIATE_TEST_SUITE_P(Data, ReadRealDeepImage,
                         testing::Values(Real{"deep/representative_deep_image.exr", 150, 100, 191482, 227},
                                         Real{"deep/leaves.exr", 1024, 576, 291861, 2}));

}  // namespace
}  // namespace shadowbench::scene
