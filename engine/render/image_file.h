// Encodes a picture as an image file in memory.
#pragma once

#include <string>

#include "render/image.h"

namespace shadowbench::render {

// OpenEXR with half floats; values stay linear.
std::string encode_exr(const Image& image);

// PNG, 8 bits a channel with sRGB's transfer function; values are clamped to [0, 1].
std::string encode_png(const Image& image);

}  // namespace shadowbench::render
