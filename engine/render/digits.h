// Draws numbers in a picture without a font file: digits of 5 x 7 dots.
#pragma once

#include <string_view>

#include "render/image.h"

namespace shadowbench::render {

inline constexpr int digit_width = 5, digit_height = 7;

// Width of the text in pixels, with dots of scale x scale pixels; digits are one dot apart.
int text_width(std::string_view text, int scale);

// Draws digits, '.', '-' and 'e' with the upper left corner at (x, y); other characters leave a gap. Clips to the
// picture.
void draw_digits(Image& image, int x, int y, int scale, std::string_view text, const base::Vec3f& colour);

}  // namespace shadowbench::render
