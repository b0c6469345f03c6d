#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "scene/readers/files.h"
#include "scene/support.h"
#include "techniques/live_bytes.h"

namespace shadowbench::scene {
namespace {

using test::error_of;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr float infinity = std::numeric_limits<float>::infinity();

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
    const auto message = [](const Sample& sample) {
        return error_of([&] { read_deep_image(write({"A", "Z", "ZBack"}, {{{0.5f, 1, 1}}, sample})); }).message();
    };
    const auto pixel = HasSubstr("pixel (1, 0), sample 1");
    EXPECT_THAT(message({{nan, 1, 1}}), AllOf(pixel, HasSubstr("not finite")));
    EXPECT_THAT(message({{infinity, 1, 1}}), AllOf(pixel, HasSubstr("not finite")));
    EXPECT_THAT(message({{0.5f, 2, nan}}), AllOf(pixel, HasSubstr("not a number")));
    EXPECT_THAT(message({{0.5f, nan, 2}}), AllOf(pixel, HasSubstr("not a number")));
    EXPECT_THAT(message({{0.5f, -infinity, 2}}), AllOf(pixel, HasSubstr("Z -inf")));
    EXPECT_THAT(message({{0.5f, -1e19f, 2}}), AllOf(pixel, HasSubstr("Z -1e+19")));
    EXPECT_THAT(message({{2, 1, 1}}), AllOf(pixel, HasSubstr("alpha 2")));
    EXPECT_THAT(message({{-1, 1, 1}}), AllOf(pixel, HasSubstr("alpha -1")));
}

// "Interpreting OpenEXR Deep Pixels": ZBack is the end of a volume; 0, or any value before Z, means a surface.
TEST(ReadDeepImage, TakesABackThatIsNotBehindForASurface) {
    const DeepImage image = read_deep_image(write(
        {"A", "Z", "ZBack"}, {{{0.5f, 3, 0}}, {{0.25f, 1, 2}}, {{0.5f, 2, 1}}, {{1, 4, -infinity}}, {{0, -2, 0}}}));
    EXPECT_THAT(image.z_front, ElementsAre(-2, 1, 2, 3, 4));
    EXPECT_THAT(image.z_back, ElementsAre(0, 2, 2, 3, 4));
    EXPECT_THAT(image.notes.lines, ElementsAre("3 of 5 samples have their ZBack before Z: taken as surfaces"));
}

TEST(ReadDeepImage, KeepsSamplesAtInfinityBehindEverything) {
    const DeepImage image =
        read_deep_image(write({"A", "Z"}, {{{1, infinity}}, {{0.5f, 1e30f}}, {{0.25f, 7}}, {{0.5f, 1.5e18f}}}));
    EXPECT_THAT(image.z_front, ElementsAre(7, 1.5e18f, 1e30f, infinity));
    EXPECT_EQ(image.z_back, image.z_front);
    EXPECT_THAT(image.transmittance, ElementsAre(0.75f, 0.5f, 0.5f, 0));
    for (std::size_t s = 0; s < 4; ++s) EXPECT_EQ(behind_everything(image, s), s > 0);
    ASSERT_EQ(image.notes.lines.size(), 1u);
    EXPECT_THAT(image.notes.lines[0], HasSubstr("3 of 4 samples are at infinity"));
}

// (1 - alpha)^(share of the way) is 1 everywhere in an infinite segment, and 0 behind its front if alpha is 1.
TEST(ReadDeepImage, AnEndlessStretchIsFarOrWhereItIsOpaqueASurface) {
    const DeepImage image = read_deep_image(write({"A", "Z", "ZBack"}, {{{0.5f, 3, infinity}}, {{1, 4, 1e30f}}}));
    EXPECT_THAT(image.z_front, ElementsAre(3, 4));
    EXPECT_TRUE(behind_everything(image, 0));
    EXPECT_EQ(image.z_back[1], 4.0f);
    EXPECT_FALSE(behind_everything(image, 1));
    const DeepImage red = read_deep_image(
        write({"AR", "AG", "AB", "Z", "ZBack"}, {{{1, 0.5f, 0, 3, infinity}}, {{0.5f, 0.5f, 0, 4, infinity}}}));
    EXPECT_THAT(red.transmittance, ElementsAre(0, 1, 1, 0.5f, 0.5f, 1));
    EXPECT_FALSE(behind_everything(red, 0));
    EXPECT_TRUE(behind_everything(red, 1));
}

TEST(ReadDeepImage, ReadsAnAlphaOfEachColour) {
    const DeepImage image =
        read_deep_image(write({"A", "AB", "AG", "AR", "Z"}, {{{0.5f, 0.75f, 0.5f, 0.25f, 4}}, {{9, 0, 1, 0.5f, 2}}}));
    EXPECT_EQ(image.channels, 3);
    EXPECT_THAT(image.z_front, ElementsAre(2, 4));
    EXPECT_THAT(image.transmittance, ElementsAre(0.5f, 0, 1, 0.75f, 0.5f, 0.25f));
    // A stands for a colour that has no alpha of its own; if there is none, A is not needed.
    EXPECT_THAT(read_deep_image(write({"A", "AG", "Z"}, {{{0.5f, 0.25f, 4}}})).transmittance,
                ElementsAre(0.5f, 0.75f, 0.5f));
    EXPECT_THAT(read_deep_image(write({"AR", "AG", "AB", "Z"}, {{{0, 0.25f, 0.5f, 4}}})).transmittance,
                ElementsAre(1, 0.75f, 0.5f));
    EXPECT_THAT(error_of([] {
                    read_deep_image(write({"AR", "AG", "Z"}, {{{0, 0.25f, 4}}}));
                }).message(),
                HasSubstr("A and Z are needed"));
}

// Names from before OpenEXR 2; without them the file would be read in grey.
TEST(ReadDeepImage, ReadsTheOlderNamesOfTheColoursAlphas) {
    const DeepImage image = read_deep_image(write({"A", "BA", "GA", "RA", "Z"}, {{{0.5f, 0.75f, 0.5f, 0.25f, 4}}}));
    EXPECT_EQ(image.channels, 3);
    EXPECT_THAT(image.transmittance, ElementsAre(0.75f, 0.5f, 0.25f));
    EXPECT_THAT(read_deep_image(write({"AB", "AG", "AR", "RA", "Z"}, {{{0.75f, 0.5f, 0.25f, 1, 4}}})).transmittance,
                ElementsAre(0.75f, 0.5f, 0.25f));
    EXPECT_THAT(read_deep_image(write({"l.BA", "l.GA", "l.RA", "l.Z"}, {{{0.75f, 0.5f, 0.25f, 4}}})).transmittance,
                ElementsAre(0.75f, 0.5f, 0.25f));
}

// Passed over, such a back would turn a volume into a surface.
TEST(ReadDeepImage, ReadsABackThatIsWrittenInOtherLetters) {
    for (const char* back : {"Zback", "zback", "ZBACK"})
        EXPECT_THAT(read_deep_image(write({"A", "Z", back}, {{{0.5f, 4, 6}}})).z_back, ElementsAre(6)) << back;
    EXPECT_THAT(read_deep_image(write({"rgba.A", "rgba.Z", "rgba.Zback"}, {{{0.5f, 4, 6}}})).z_back, ElementsAre(6));
    EXPECT_THAT(read_deep_image(write({"A", "Z", "Zbacks"}, {{{0.5f, 4, 6}}})).z_back, ElementsAre(4));
}

TEST(ReadDeepImage, EqualAlphasAreOneChannel) {
    const DeepImage image =
        read_deep_image(write({"A", "AR", "AG", "AB", "Z"}, {{{0, 0.25f, 0.25f, 0.25f, 4}}, {{0, 1, 1, 1.001f, 5}}}));
    EXPECT_EQ(image.channels, 1);
    EXPECT_THAT(image.transmittance, ElementsAre(0.75f, 0));
    EXPECT_THAT(image.notes.lines, ElementsAre(HasSubstr("1 of 2 samples have an alpha just outside [0, 1]")));
}

TEST(ReadDeepImage, TakesTheOnlyLayerThatHasAlphaAndZ) {
    const std::vector<Sample> samples{{{0.5f, 4, 6, 9, 8}}};
    const auto file = write({"rgba.A", "rgba.Z", "rgba.ZBack", "rgba.R", "other.Z"}, samples);
    for (const DeepChoice& choice : {DeepChoice{}, DeepChoice{"rgba", {}}}) {
        const DeepImage image = read_deep_image(file, choice);
        EXPECT_THAT(image.z_front, ElementsAre(4));
        EXPECT_THAT(image.z_back, ElementsAre(6));
        EXPECT_TRUE(image.notes.lines.empty());
    }
    for (const char* layer : {"other", "", "rgba.A"})
        EXPECT_THAT(error_of([&] {
                        read_deep_image(file, {layer, {}});
                    }).message(),
                    AllOf(HasSubstr("no layer"), HasSubstr("that have them: rgba")));
}

TEST(ReadDeepImage, AsksWhichOfSeveralLayersIsMeant) {
    const auto file = write({"a.A", "a.Z", "b.c.A", "b.c.Z"}, {{{0.5f, 4, 0.25f, 5}}});
    EXPECT_THAT(error_of([&] { read_deep_image(file); }).message(), AllOf(HasSubstr("\"layer\""), HasSubstr("a, b.c")));
    EXPECT_THAT(read_deep_image(file, {"b.c", {}}).z_front, ElementsAre(5));
    EXPECT_THAT(read_deep_image(file, {"a", {}}).transmittance, ElementsAre(0.5f));
    // Channels without a layer are the image.
    const auto image = write({"A", "Z", "b.A", "b.Z"}, {{{0.5f, 4, 0.25f, 5}}});
    EXPECT_THAT(read_deep_image(image).z_front, ElementsAre(4));
    EXPECT_THAT(read_deep_image(image).notes.lines, ElementsAre(HasSubstr("passed over: b")));
    EXPECT_THAT(read_deep_image(image, {"b", {}}).z_front, ElementsAre(5));
    EXPECT_THAT(read_deep_image(image, {"", {}}).z_front, ElementsAre(4));
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

// The library reads some values at their own size and takes the bytes after them for attributes: a value that claims to
// be longer could hide a text of 2 GB there.
TEST(ReadDeepImage, RefusesAttributesOfAnotherSizeThanTheirType) {
    const std::string bytes = test::read_bytes(write({"A", "Z"}, {{{0.5f, 4}}}));
    for (const std::string& mark :
         {std::string("lineOrder\0lineOrder\0\x01", 21), std::string("pixelAspectRatio\0float\0\x04", 24),
          std::string("dataWindow\0box2i\0\x10", 18), std::string("channels\0chlist\0\x25", 17)}) {
        const std::size_t at = bytes.find(mark);
        ASSERT_NE(at, std::string::npos) << mark;
        for (const int by : {-1, 1, 40}) {
            std::string other = bytes;
            char& size = other[at + mark.size() - 1];
            size = static_cast<char>(size + by);
            const auto file = test::write_file("size.exr", other);
            EXPECT_EQ(error_of([&] { read_deep_image(file); }).code(), base::ErrorCode::bad_input) << mark << by;
            EXPECT_THAT(error_of([&] { read_deep_image(file); }).where(), testing::StartsWith(file.string() + ":"));
        }
    }
}

TEST(ReadDeepImage, ChecksPreviewsAndListsOfTexts) {
    const std::string bytes = test::read_bytes(write({"A", "Z"}, {{{0.5f, 4}}}));
    const auto with = [&](const std::string& name_and_type, const std::string& value) {
        std::string other = bytes;
        other.insert(8, name_and_type + test::bytes_of(static_cast<std::uint32_t>(value.size())) + value);
        // The table of places lies behind the header: all move.
        const std::size_t table = other.find(std::string("version\0int\0", 12)) + 12 + 8 + 1;
        std::uint64_t place = 0;
        std::memcpy(&place, other.data() + table, sizeof place);
        place += other.size() - bytes.size();
        std::memcpy(other.data() + table, &place, sizeof place);
        return test::write_file("attribute.exr", other);
    };
    const std::string texts("names\0stringvector\0", 19), preview("preview\0preview\0", 16);
    const std::string one = test::bytes_of(2u) + "ab";
    EXPECT_EQ(read_deep_image(with(texts, one + one)).z_front.size(), 1u);
    EXPECT_EQ(read_deep_image(with(preview, test::bytes_of(1u, 2u) + "12345678")).z_front.size(), 1u);
    for (const auto& file :
         {with(texts, one + test::bytes_of(0x7fffffffu) + "ab"), with(texts, one + "ab"),
          with(preview, test::bytes_of(1u, 3u) + "12345678"), with(preview, test::bytes_of(0x8000u, 0x20000u)),
          with(std::string("list\0floatvector\0", 17), "12345")})
        EXPECT_EQ(error_of([&] { read_deep_image(file); }).code(), base::ErrorCode::bad_input);
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

// Rows are read a few at a time, with and without tiles: each pixel must keep its own samples.
TEST(ReadDeepImage, TakesTheRowsOfEveryPart) {
    constexpr int width = 5, height = 37;
    for (const int tile : {0, 16}) {
        const std::filesystem::path file = test::fresh_path("rows.exr");
        OIIO::ImageSpec spec(width, height, 2, OIIO::TypeDesc::FLOAT);
        spec.deep = true;
        spec.channelnames = {"A", "Z"};
        spec.x = 3;
        spec.y = -7;  // where the data window begins
        if (tile > 0) spec.tile_width = spec.tile_height = tile;
        OIIO::DeepData data;
        data.init(spec);
        for (int pixel = 0; pixel < width * height; ++pixel) data.set_samples(pixel, pixel % 3);
        for (int pixel = 0; pixel < width * height; ++pixel)
            for (int sample = 0; sample < pixel % 3; ++sample) {
                data.set_deep_value(pixel, 0, sample, 0.5f);
                data.set_deep_value(pixel, 1, sample, static_cast<float>(10 * pixel + sample));
            }
        const auto output = OIIO::ImageOutput::create(file.string());
        ASSERT_TRUE(output && output->open(file.string(), spec));
        ASSERT_TRUE(output->write_deep_image(data)) << output->geterror();
        output->close();
        const DeepImage image = read_deep_image(file);
        ASSERT_EQ(image.begin.size(), static_cast<std::size_t>(width * height + 1));
        for (std::size_t pixel = 0; pixel + 1 < image.begin.size(); ++pixel) {
            ASSERT_EQ(image.begin[pixel + 1] - image.begin[pixel], pixel % 3) << pixel;
            for (std::size_t sample = 0; sample < pixel % 3; ++sample)
                ASSERT_EQ(image.z_front[image.begin[pixel] + sample], static_cast<float>(10 * pixel + sample));
        }
    }
}

// OpenImageIO would hold all channels of all samples beside the image that is made of them, twice as much.
TEST(ReadDeepImage, HoldsAFewRowsBesideTheImage) {
    constexpr int side = 128, samples = 16;
    const std::filesystem::path file = test::fresh_path("large.exr");
    OIIO::ImageSpec spec(side, side, 6, OIIO::TypeDesc::FLOAT);
    spec.deep = true;
    spec.channelnames = {"R", "G", "B", "A", "Z", "ZBack"};
    spec.attribute("compression", "none");
    {
        OIIO::DeepData data;
        data.init(spec);
        data.set_all_samples(std::vector<unsigned>(side * side, samples));
        for (int pixel = 0; pixel < side * side; ++pixel)
            for (int sample = 0; sample < samples; ++sample)
                for (int channel = 3; channel < 6; ++channel) data.set_deep_value(pixel, channel, sample, 0.5f);
        const auto output = OIIO::ImageOutput::create(file.string());
        ASSERT_TRUE(output && output->open(file.string(), spec));
        ASSERT_TRUE(output->write_deep_image(data)) << output->geterror();
        output->close();
    }
    techniques::testing::forget_peak();
    const std::size_t before = techniques::testing::live_bytes();
    const DeepImage image = read_deep_image(file);
    ASSERT_EQ(image.z_front.size(), std::size_t{side} * side * samples);
    const double kept = 12.0 * side * side * samples;
    EXPECT_LT(static_cast<double>(techniques::testing::peak_bytes() - before), 2.2 * kept);
}

}  // namespace
}  // namespace shadowbench::scene
