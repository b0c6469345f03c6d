#include "claims/panels.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "render/digits.h"
#include "render/display.h"

namespace shadowbench::claims {
namespace {

using render::Image;

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
