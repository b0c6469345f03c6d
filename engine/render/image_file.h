// Encodes a picture as an image file in memory.
#pragma once

#include <string>

#include "render/image.h"

namespace shadowbench::render {

// sRGB's transfer function, IEC 61966-2-1: linear [0, 1] to display [0, 1].
double to_display(double linear);
double from_display(double shown);  // its inverse

// OpenEXR with half floats; values stay linear.
std::string encode_exr(const Image& image);

// PNG, 8 bits a channel with sRGB's transfer function; values are clamped to [0, 1].
std::string encode_png(const Image& image);

}  // namespace shadowbench::render
