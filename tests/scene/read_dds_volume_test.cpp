#include <OpenImageIO/imageio.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "base/random.h"
#include "scene/readers/files.h"
#include "scene/readers/kinds.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::bytes_of;
using test::error_of;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::uint32_t volume = 0x200000, alpha = 0x1, only_alpha = 0x2, code = 0x4, rgb = 0x40, luminance = 0x20000;

struct Texels {
    std::uint32_t flags = code;
    std::string name = "DXT5";
    std::uint32_t bits = 0;
    std::array<std::uint32_t, 4> masks{};
};

std::string header(const Vec3i& size, const Texels& texels, std::uint32_t second_caps = volume,
                   std::uint32_t mip_levels = 0) {
    std::string bytes =
        "DDS " + bytes_of(124u, 0x801007u | (mip_levels > 0 ? 0x20000u : 0u), size.y, size.x, 0u, size.z, mip_levels);
    bytes += std::string(44, '\0') + bytes_of(32u, texels.flags) + texels.name +
             bytes_of(texels.bits, texels.masks, 0x401008u, second_caps, 0u, 0u, 0u);
    return bytes;
}

// The header with the extra header of Direct3D 10.
std::string header_10(const Vec3i& size, std::uint32_t format, std::uint32_t dimension = 4) {
    return header(size, {code, "DX10"}, 0) + bytes_of(format, dimension, 0u, 1u, 0u);
}

GridVolume read(const std::string& bytes, DdsChannel channel = DdsChannel::usual) {
    return read_dds_volume(test::write_file("a.dds", bytes), channel);
}
std::string message(const std::string& bytes, DdsChannel channel = DdsChannel::usual) {
    return error_of([&] { read(bytes, channel); }).message();
}

// A block of equal texels, black: its two ends are both this alpha, and every index is 0.
std::string flat_block(int alpha_value) {
    return std::string(2, static_cast<char>(alpha_value)) + std::string(14, '\0');
}

// A block whose texel i has the alpha index i % 8 and the colour index i % 4.
std::string block(int first_alpha, int second_alpha, unsigned first_colour, unsigned second_colour) {
    std::uint64_t alphas = 0;
    std::uint32_t colours = 0;
    for (unsigned i = 0; i < 16; ++i) {
        alphas |= std::uint64_t{i % 8} << (3 * i);
        colours |= (i % 4) << (2 * i);
    }
    return std::string{static_cast<char>(first_alpha), static_cast<char>(second_alpha)} +
           bytes_of(alphas).substr(0, 6) +
           bytes_of(static_cast<std::uint16_t>(first_colour), static_cast<std::uint16_t>(second_colour), colours);
}

TEST(ReadDdsVolume, InterpolatesTheAlphaOfABlockInBothWays) {
    const std::vector<float> eight = read(header({4, 4, 1}, {}) + block(255, 0, 0, 0)).density,
                             six = read(header({4, 4, 1}, {}) + block(51, 102, 0, 0)).density;
    constexpr float expected_eight[] = {1, 0, 6 / 7.0f, 5 / 7.0f, 4 / 7.0f, 3 / 7.0f, 2 / 7.0f, 1 / 7.0f};
    constexpr float expected_six[] = {0.2f, 0.4f, 0.24f, 0.28f, 0.32f, 0.36f, 0, 1};
    for (std::size_t i = 0; i < 16; ++i) {
        EXPECT_NEAR(eight[i], expected_eight[i % 8], 1e-6) << i;
        EXPECT_NEAR(six[i], expected_six[i % 8], 1e-6) << i;
    }
}

TEST(ReadDdsVolume, InterpolatesTheChosenColour) {
    const std::string bytes = header({4, 4, 1}, {}) + block(0, 0, 0xf800 | 21 << 5, 31);  // red and some green; blue
    const std::vector<float> red = read(bytes, DdsChannel::red).density, green = read(bytes, DdsChannel::green).density,
                             blue = read(bytes, DdsChannel::blue).density;
    constexpr float share[] = {1, 0, 2 / 3.0f, 1 / 3.0f};  // of the first colour
    for (std::size_t i = 0; i < 16; ++i) {
        EXPECT_NEAR(red[i], share[i % 4], 1e-6);
        EXPECT_NEAR(green[i], share[i % 4] / 3.0f, 1e-6);
        EXPECT_NEAR(blue[i], 1.0f - share[i % 4], 1e-6);
    }
}

// OpenImageIO reads the first slice of a volume, rounded to 8 bits.
void expect_agreement_on_random_blocks(const char* name) {
    SCOPED_TRACE(name);
    base::Random random(11);
    const Vec3i size(16, 8, 1);
    std::string bytes = header(size, {code, name});
    for (int i = 0; i < 4 * 2 * 16; ++i) bytes += static_cast<char>(random.below(256));
    const auto file = test::write_file("random.dds", bytes);
    const auto input = OIIO::ImageInput::open(file.string());
    ASSERT_TRUE(input);
    std::vector<std::uint8_t> pixels(16 * 8 * 4);
    ASSERT_TRUE(input->read_image(0, 0, 0, 4, OIIO::TypeDesc::UINT8, pixels.data()));
    for (const auto& [channel, index] :
         {std::pair{DdsChannel::red, 0u}, {DdsChannel::green, 1u}, {DdsChannel::blue, 2u}, {DdsChannel::alpha, 3u}}) {
        const GridVolume volume_of_file = read_dds_volume(file, channel);
        ASSERT_EQ(volume_of_file.density.size(), 128u);
        for (std::size_t i = 0; i < 128; ++i)
            EXPECT_NEAR(255.0f * volume_of_file.density[i], pixels[4 * i + index], 1.5f) << i << " of " << index;
    }
}

TEST(ReadDdsVolume, AgreesWithAnotherDecoderOnRandomBlocks) {
    expect_agreement_on_random_blocks("DXT5");
    expect_agreement_on_random_blocks("DXT3");
}

// Taken as BC3, the first byte would be the alpha of the first two texels.
TEST(ReadDdsVolume, ReadsFourBitsOfAlphaFromABlockOfTheOtherFormat) {
    const std::string bytes = std::string("\x0f\xf0\x63\x36\x00\x00\xff\xff", 8) + std::string(8, '\0');
    const auto expected = ElementsAre(1.0f, 0.0f, 0.0f, 1.0f, 0.2f, 0.4f, 0.4f, 0.2f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 1.0f,
                                      1.0f, 1.0f);
    EXPECT_THAT(read(header({4, 4, 1}, {code, "DXT3"}) + bytes).density, expected);
    EXPECT_THAT(read(header_10({4, 4, 1}, 74) + bytes).density, expected);
}

TEST(ReadDdsVolume, ReadsSlicesOneAfterTheOtherAndCutsBlocksAtTheBorder) {
    // 5 x 3 x 2 texels: two blocks a slice.
    const GridVolume grid =
        read(header({5, 3, 2}, {}) + flat_block(51) + flat_block(102) + flat_block(153) + flat_block(204));
    EXPECT_EQ(grid.size, Vec3i(5, 3, 2));
    ASSERT_EQ(grid.density.size(), 30u);
    for (std::size_t i = 0; i < 30; ++i)
        EXPECT_FLOAT_EQ(grid.density[i], 0.2f + (i % 5 == 4 ? 0.2f : 0.0f) + (i >= 15 ? 0.4f : 0.0f)) << i;
}

// As old tools write them.
TEST(ReadDdsVolume, ReadsADepthWithoutTheFlagOfVolumes) {
    const auto file = test::write_file("old.dds", header({4, 4, 2}, {}, 0) + flat_block(255) + flat_block(0));
    EXPECT_TRUE(is_dds_volume(file));
    EXPECT_EQ(read_dds_volume(file).density[31], 0.0f);
    EXPECT_FALSE(is_dds_volume(test::write_file("flat.dds", header({4, 4, 1}, {}, 0) + flat_block(255))));
}

TEST(ReadDdsVolume, ReadsTheLargestMipLevelAndSaysSo) {
    const std::string bytes =
        header({4, 4, 2}, {}, volume, 3) + flat_block(255) + flat_block(255) + flat_block(0) + flat_block(0);
    const GridVolume grid = read(bytes);
    EXPECT_EQ(grid.size, Vec3i(4, 4, 2));
    EXPECT_THAT(grid.density, Each(1.0f));
    EXPECT_THAT(grid.notes.lines, ElementsAre("its largest mip level is read and 2 passed over"));
}

// Two texels behind each other; the channels of the first are 0x33, 0x66, 0x99, 0xcc.
TEST(ReadDdsVolume, ReadsChannelsOf8BitsWithoutCompression) {
    const std::string texels("\x33\x66\x99\xcc\xff\xff\xff\xff", 8);
    const Vec3i size(1, 1, 2);
    const auto first = [&](const Texels& format, DdsChannel channel) {
        const std::vector<float> density =
            read(header(size, format) + texels.substr(0, format.bits / 4), channel).density;
        EXPECT_EQ(density.size(), 2u);
        return density[0];
    };
    const std::string none(4, '\0');
    const Texels argb{rgb | alpha, none, 32, {0xff0000, 0xff00, 0xff, 0xff000000}};
    EXPECT_EQ(first(argb, DdsChannel::usual), 0.8f);
    EXPECT_EQ(first(argb, DdsChannel::red), 0.6f);
    EXPECT_EQ(first(argb, DdsChannel::green), 0.4f);
    EXPECT_EQ(first(argb, DdsChannel::blue), 0.2f);
    EXPECT_EQ(first({luminance, none, 8, {0xff, 0, 0, 0}}, DdsChannel::usual), 0.2f);
    EXPECT_EQ(first({luminance, none, 8, {0xff, 0, 0, 0}}, DdsChannel::green), 0.2f);
    EXPECT_EQ(first({luminance | alpha, none, 16, {0xff, 0, 0, 0xff00}}, DdsChannel::usual), 0.4f);
    EXPECT_EQ(first({only_alpha, none, 8, {0, 0, 0, 0xff}}, DdsChannel::usual), 0.2f);
    const Texels three{rgb, none, 24, {0xff, 0xff00, 0xff0000, 0}};
    EXPECT_EQ(first(three, DdsChannel::blue), 0.6f);
    EXPECT_THAT(message(header(size, three) + texels), HasSubstr("give \"channel\""));
    EXPECT_THAT(message(header(size, three) + texels, DdsChannel::alpha), HasSubstr("no alpha channel"));
}

TEST(ReadDdsVolume, ReadsTheFormatsOfTheExtraHeader) {
    const std::string texel("\x33\x66\x99\xcc", 4);
    EXPECT_THAT(read(header_10({1, 1, 1}, 28) + texel, DdsChannel::red).density, ElementsAre(0.2f));
    EXPECT_THAT(read(header_10({1, 1, 1}, 87) + texel, DdsChannel::red).density, ElementsAre(0.6f));
    EXPECT_THAT(read(header_10({1, 1, 1}, 61) + texel).density, ElementsAre(0.2f));
    EXPECT_THAT(read(header_10({1, 1, 1}, 65) + texel).density, ElementsAre(0.2f));
    EXPECT_THAT(read(header_10({4, 4, 1}, 77) + flat_block(255)).density, Each(1.0f));
    EXPECT_THAT(message(header_10({4, 4, 1}, 98) + flat_block(255)), HasSubstr("DXGI format 98"));
    EXPECT_THAT(message(header_10({4, 4, 1}, 77, 3) + flat_block(255)), HasSubstr("a flat texture"));
}

TEST(ReadDdsVolume, NamesTheFaultsOfAHeader) {
    const std::string none(4, '\0');
    EXPECT_THAT(message(header({4, 4, 1}, {}, 0) + flat_block(0)), HasSubstr("a flat texture"));
    EXPECT_THAT(message(header({4, 4, 0}, {})), HasSubstr("4 x 4 x 0 voxels"));
    EXPECT_THAT(message(header({2000, 2000, 2000}, {})), HasSubstr("1 to 1000000000 are read"));
    EXPECT_THAT(message(header({4, 4, 1}, {code, "DXT1"})), HasSubstr("DXT5 (BC3) blocks"));
    EXPECT_THAT(message(header({4, 4, 1}, {rgb, none, 16, {0xf800, 0x7e0, 0x1f, 0}})), HasSubstr("bit mask 0xf800"));
    EXPECT_THAT(message(header({4, 4, 1}, {rgb, none, 12, {}})), HasSubstr("texels of 12 bits"));
    EXPECT_THAT(message(header({4, 4, 1}, {0x80000, none, 8, {0xff, 0, 0, 0}})), HasSubstr("of the kind 0x80000"));
    EXPECT_THAT(message("DDS v3d\n" + std::string(200, '\0')), HasSubstr("not a DDS texture"));
    EXPECT_EQ(error_of([] { read_dds_volume("/nowhere/a.dds"); }).code(), base::ErrorCode::no_such_file);
}

TEST(ReadDdsVolume, RefusesAFileCutAnywhere) {
    const Texels flat{luminance, std::string(4, '\0'), 8, {0xff, 0, 0, 0}};
    for (const std::string& bytes :
         {header({5, 3, 2}, {}) + flat_block(9) + flat_block(8) + flat_block(7) + flat_block(6),
          header({3, 2, 2}, flat) + std::string(12, 'x'), header_10({1, 1, 1}, 61) + "x"}) {
        EXPECT_NO_THROW(read(bytes));
        test::expect_cuts_refused(bytes, "cut.dds", bytes.size(), [](const auto& file) { read_dds_volume(file); });
    }
}

TEST(ReadDdsVolume, GivesAVolumeOrAnErrorWhateverByteIsChanged) {
    const Texels flat{luminance, std::string(4, '\0'), 8, {0xff, 0, 0, 0}};
    for (const std::string& bytes : {header({4, 4, 2}, {}) + block(255, 0, 9, 8) + block(3, 200, 7, 6),
                                     header({3, 2, 2}, flat) + std::string(12, 'x'), header_10({1, 1, 1}, 28) + "abcd"})
        test::expect_changes_survived(bytes, "changed.dds", [](const auto& file) { return read_dds_volume(file); });
}

}  // namespace
}  // namespace shadowbench::scene
