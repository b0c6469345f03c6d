#include "render/heat_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render/digits.h"
#include "render/display.h"

namespace shadowbench::render {
namespace {

using base::Vec3f;

base::Vec3i display(const Vec3f& linear) {
    base::Vec3i result;
    for (int c = 0; c < 3; ++c) result[c] = static_cast<int>(std::lround(255.0 * to_display(linear[c])));
    return result;
}

void expect_near(const base::Vec3i& a, const base::Vec3i& b, int tolerance) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << c;
}

TEST(HeatMap, shows_the_published_colours_of_viridis) {
    const std::vector<float> values{0.0f, 0.1f, 0.2f, 5.0f};
    const Image image = heat_map(values, 4, 1, 0.2);
    expect_near(display(image.at(0, 0)), {68, 1, 84}, 2);
    expect_near(display(image.at(1, 0)), {33, 145, 140}, 3);
    expect_near(display(image.at(2, 0)), {253, 231, 37}, 2);
    EXPECT_EQ(image.at(3, 0), image.at(2, 0)) << "beyond the top";
}

TEST(HeatMap, has_its_colours_and_numbers_below) {
    const int width = 200, height = 3;
    const Image image = heat_map(std::vector<float>(600, 0.0f), width, height, 0.05);
    ASSERT_EQ(image.height, height + legend_height());
    const int bar = height + 8;
    expect_near(display(image.at(5, bar)), {68, 1, 84}, 6);
    expect_near(display(image.at(width - 6, bar)), {253, 231, 37}, 6);
    int ink = 0;
    for (int y = height + 14; y < image.height; ++y)
        for (int x = 0; x < width; ++x) ink += image.at(x, y) == Vec3f(0.0f);
    // Three ticks, and the dots of 0, 0.025 and 0.05 at 2 x 2 pixels each.
    Image text({100, 7}, Vec3f(1.0f));
    draw_digits(text, 0, 0, 1, "00.0250.05", Vec3f(0.0f));
    int dots = 0;
    for (const Vec3f& p : text.pixels) dots += p == Vec3f(0.0f);
    EXPECT_EQ(ink, 4 * dots + 3 * 3);
}

TEST(HeatMap, of_a_tiny_picture_still_has_its_values) {
    const Image image = heat_map(std::vector<float>{0.0f, 1.0f}, 1, 2, 1.0);
    EXPECT_EQ(image.width, 1);
    expect_near(display(image.at(0, 1)), {253, 231, 37}, 2);
}

TEST(HeatMap, legend_reaches_to_a_round_number_above_the_error) {
    EXPECT_EQ(legend_top(0.0), 0.01);
    EXPECT_EQ(legend_top(0.05), 0.05);
    EXPECT_EQ(legend_top(0.051), 0.1);
    EXPECT_EQ(legend_top(7.0), 1.0);
}

TEST(Digits, are_drawn_at_their_place_and_clipped_at_the_border) {
    Image image({8, 9}, Vec3f(0.0f));
    draw_digits(image, 1, 1, 1, "1", Vec3f(1.0f));
    EXPECT_EQ(image.at(3, 1), Vec3f(1.0f)) << "the tip of the 1";
    EXPECT_EQ(image.at(2, 7), Vec3f(1.0f)) << "its foot";
    EXPECT_EQ(image.at(1, 1), Vec3f(0.0f));
    EXPECT_NO_THROW(draw_digits(image, -3, 5, 3, "8.-e", Vec3f(1.0f)));
    EXPECT_EQ(text_width("0.05", 2), (4 * 6 - 1) * 2);
    EXPECT_EQ(text_width("", 2), 0);
}

}  // namespace
}  // namespace shadowbench::render
