// A picture: linear RGB of sRGB's primaries, row 0 at the top.
#pragma once

#include <cstddef>
#include <vector>

#include "base/vec.h"

namespace shadowbench::render {

struct Image {
    int width = 0, height = 0;
    std::vector<base::Vec3f> pixels;  // width * height

    Image() = default;
    Image(base::Vec2i size, const base::Vec3f& colour)
        : width(size.x), height(size.y), pixels(static_cast<std::size_t>(size.x) * size.y, colour) {}

    base::Vec3f& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
    const base::Vec3f& at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width + x]; }
};

}  // namespace shadowbench::render
