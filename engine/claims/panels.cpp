#include "claims/panels.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "render/digits.h"
#include "render/display.h"

namespace shadowbench::claims {
namespace {

using render::Image;

constexpr float grey = 0.3f;  // linear; about 148 of 255 on a display
constexpr double bright = 0.9, bright_share = 0.99;
constexpr int gap = 4, number_scale = 3, number_margin = 6;  // pixels

void paste(const Image& from, int x0, int y0, Image& to) {
    for (int y = 0; y < from.height; ++y)
        for (int x = 0; x < from.width; ++x) to.at(x0 + x, y0 + y) = from.at(x, y);
}

// Black digits on a white field.
void draw_number(Image& image, int number) {
    const std::string text = std::to_string(number);
    const int width = render::text_width(text, number_scale) + 2 * number_margin,
              height = number_scale * render::digit_height + 2 * number_margin;
    const int top = std::max(image.height - height, 0);
    for (int y = top; y < image.height; ++y)
        for (int x = 0; x < std::min(width, image.width); ++x) image.at(x, y) = base::Vec3f(1.0f);
    render::draw_digits(image, number_margin, top + number_margin, number_scale, text, base::Vec3f(0.0f));
}

}  // namespace

double print_exposure(const Image& picture, std::span<const float> seen) {
    std::vector<float> brightest;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const base::Vec3f& pixel = picture.pixels[i];
        if (seen[i] > 0.5f) brightest.push_back(std::max({pixel.x, pixel.y, pixel.z}));
    }
    if (brightest.empty()) return 1.0;
    const auto rank = static_cast<std::ptrdiff_t>(bright_share * static_cast<double>(brightest.size() - 1));
    std::nth_element(brightest.begin(), brightest.begin() + rank, brightest.end());
    const double most = brightest[static_cast<std::size_t>(rank)];
    return most > 0.0 ? bright / most : 1.0;
}

Image on_grey(const Image& picture, std::span<const float> seen, double exposure) {
    Image result = picture;
    for (std::size_t i = 0; i < result.pixels.size(); ++i)
        result.pixels[i] = result.pixels[i] * static_cast<float>(exposure) + base::Vec3f((1.0f - seen[i]) * grey);
    return result;
}

Image dark_on_white(const Image& difference) {
    Image result = difference;
    for (base::Vec3f& pixel : result.pixels)
        for (int c = 0; c < 3; ++c) {
            const double shown = render::to_display(std::clamp<double>(pixel[c], 0.0, 1.0));
            pixel[c] = static_cast<float>(render::from_display(1.0 - shown));
        }
    return result;
}

Image side_by_side(std::span<const Panel> panels) {
    const int width = panels.front().above.width, height = panels.front().above.height;
    Image sheet({static_cast<int>(panels.size()) * (width + gap) - gap, 2 * height + gap}, base::Vec3f(1.0f));
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const int x = static_cast<int>(i) * (width + gap);
        Image above = panels[i].above;
        draw_number(above, static_cast<int>(i) + 1);
        paste(above, x, 0, sheet);
        paste(panels[i].below, x, height + gap, sheet);
    }
    return sheet;
}

}  // namespace shadowbench::claims
