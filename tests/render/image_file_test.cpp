#include "render/image_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "render/display.h"

namespace shadowbench::render {
namespace {

using base::Vec3f;

struct Read {
    int width = 0, height = 0, channels = 0;
    OIIO::TypeDesc type;
    std::vector<float> values;
};

Read read(const std::string& bytes, const char* name) {
    OIIO::Filesystem::IOMemReader memory(const_cast<char*>(bytes.data()), bytes.size());
    const auto input = OIIO::ImageInput::open(name, nullptr, &memory);
    Read result;
    EXPECT_TRUE(input) << OIIO::geterror();
    if (!input) return result;
    const OIIO::ImageSpec& spec = input->spec();
    result = {spec.width, spec.height, spec.nchannels, spec.format, {}};
    result.values.resize(spec.image_pixels() * spec.nchannels);
    EXPECT_TRUE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, result.values.data()));
    return result;
}

Image steps() {  // brighter to the right, red above, blue below
    Image image({5, 3}, Vec3f(0.0f));
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 5; ++x)
            image.at(x, y) = Vec3f(y == 0 ? 1.0f : 0.0f, 0.25f * static_cast<float>(x), y == 2 ? 1.5f : 0.0f);
    return image;
}

TEST(ImageFile, exr_keeps_linear_values_and_their_places) {
    const Image image = steps();
    const Read back = read(encode_exr(image), "x.exr");
    ASSERT_EQ(back.width, 5);
    ASSERT_EQ(back.height, 3);
    ASSERT_EQ(back.channels, 3);
    EXPECT_EQ(back.type, OIIO::TypeDesc::HALF);
    for (std::size_t p = 0; p < image.pixels.size(); ++p)
        for (int c = 0; c < 3; ++c) EXPECT_EQ(back.values[3 * p + c], image.pixels[p][c]) << p;
}

TEST(ImageFile, png_has_display_values_clamped_to_what_it_can_hold) {
    Image image = steps();
    image.at(1, 1) = Vec3f(0.5f, -0.3f, std::nanf(""));
    const Read back = read(encode_png(image), "x.png");
    ASSERT_EQ(back.values.size(), 45u);
    const auto value = [&](int x, int y, int c) { return back.values[3 * (5 * y + x) + c] * 255.0f; };
    EXPECT_NEAR(value(1, 1, 0), 188.0f, 0.01f) << "half the light is 188 of 255 in sRGB";
    EXPECT_NEAR(value(1, 1, 1), 0.0f, 0.01f);
    EXPECT_NEAR(value(1, 1, 2), 0.0f, 0.01f);
    EXPECT_NEAR(value(0, 0, 0), 255.0f, 0.01f);
    EXPECT_NEAR(value(0, 2, 2), 255.0f, 0.01f) << "brighter than white";
    EXPECT_NEAR(value(4, 0, 1), 255.0f, 0.01f);
}

TEST(ImageFile, of_one_picture_has_the_same_bytes_every_time) {
    EXPECT_EQ(encode_exr(steps()), encode_exr(steps()));
    EXPECT_EQ(encode_png(steps()), encode_png(steps()));
}

TEST(ImageFile, transfer_function_meets_at_its_joint) {
    EXPECT_NEAR(to_display(0.0031308), 12.92 * 0.0031308, 1e-6);
    EXPECT_NEAR(to_display(0.0031309), 12.92 * 0.0031309, 1e-5);
    EXPECT_NEAR(to_display(1.0), 1.0, 1e-12);
}

TEST(ImageFile, TheDisplaysCurveHasItsInverse) {
    for (int i = 0; i <= 1000; ++i) {
        const double linear = i / 1000.0;
        EXPECT_NEAR(from_display(to_display(linear)), linear, 1e-6);
    }
    EXPECT_NEAR(from_display(0.5), 0.2140411, 1e-6) << "IEC 61966-2-1";
}

}  // namespace
}  // namespace shadowbench::render
