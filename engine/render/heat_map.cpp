#include "render/heat_map.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "render/colour_map.h"
#include "render/digits.h"

namespace shadowbench::render {
namespace {

using base::Vec3f;

constexpr int margin = 4, bar_height = 10, tick_height = 3, text_scale = 2;
constexpr int text_height = digit_height * text_scale;
const Vec3f paper(1.0f), ink(0.0f);

void fill(Image& image, int x0, int x1, int y0, int y1, const Vec3f& colour) {
    for (int y = y0; y < y1; ++y)
        for (int x = std::max(x0, 0); x < std::min(x1, image.width); ++x) image.at(x, y) = colour;
}

// Centres the text at x, but keeps it inside the picture.
void label(Image& image, int x, int y, double value) {
    const std::string text = fmt::format("{:g}", value);
    const int width = text_width(text, text_scale);
    draw_digits(image, std::clamp(x - width / 2, margin, image.width - width - margin), y, text_scale, text, ink);
}

void add_legend(Image& image, int top_row, double top) {
    const int left = margin, right = image.width - margin, bar = top_row + margin;
    fill(image, 0, image.width, top_row, image.height, paper);
    if (right - left < 2) return;
    std::vector<float> ramp;
    for (int x = left; x < right; ++x)
        ramp.push_back(static_cast<float>(x - left) / static_cast<float>(right - left - 1));
    const std::vector<Vec3f> shades = colour_map(ramp, right - left, 1);
    for (int x = left; x < right; ++x) fill(image, x, x + 1, bar, bar + bar_height, shades[x - left]);
    const double numbers[] = {0.0, 0.5 * top, top};
    int needed = 0;
    for (const double n : numbers) needed += text_width(fmt::format("{:g}", n), text_scale) + 2 * text_scale;
    if (needed + 2 * margin > image.width) return;
    const int tick = bar + bar_height, text = tick + tick_height + 1;
    for (int i = 0; i < 3; ++i) {
        const int x = left + i * (right - left - 1) / 2;
        fill(image, x, x + 1, tick, tick + tick_height, ink);
        label(image, x, text, numbers[i]);
    }
}

}  // namespace

double legend_top(double error) {
    for (const double top : {0.01, 0.02, 0.05, 0.1, 0.2, 0.5})
        if (error <= top) return top;
    return 1.0;
}

int legend_height() {
    return margin + bar_height + tick_height + 1 + text_height + margin;
}

Image heat_map(std::span<const float> values, int width, int height, double top) {
    std::vector<float> scaled;
    scaled.reserve(values.size());
    for (const float v : values) scaled.push_back(static_cast<float>(std::min(v / top, 1.0)));
    Image image({width, height + legend_height()}, paper);
    const std::vector<Vec3f> shades = colour_map(scaled, width, height);
    std::copy(shades.begin(), shades.end(), image.pixels.begin());
    add_legend(image, height, top);
    return image;
}

}  // namespace shadowbench::render
