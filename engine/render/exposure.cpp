#include "render/exposure.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace shadowbench::render {
namespace {

constexpr float grey = 0.3f;  // linear; about 148 of 255 on a display
constexpr double bright = 0.9, bright_share = 0.99;

}  // namespace

double exposure_of(const Image& picture, std::span<const float> seen) {
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

}  // namespace shadowbench::render
