#include <cmath>

#include "metrics/flip.h"
#include "metrics/statistics.h"
#include "render/render.h"

namespace shadowbench::render {

using base::Vec3f;

namespace {

std::vector<float> values_of(const Image& image) {
    std::vector<float> values;
    values.reserve(3 * image.pixels.size());
    for (const Vec3f& pixel : image.pixels) values.insert(values.end(), {pixel.x, pixel.y, pixel.z});
    return values;
}

}  // namespace

Image difference_times_four(const Image& image, const Image& reference) {
    Image result = image;
    for (std::size_t p = 0; p < result.pixels.size(); ++p)
        for (int c = 0; c < 3; ++c) result.pixels[p][c] = 4.0f * std::abs(image.pixels[p][c] - reference.pixels[p][c]);
    return result;
}

std::vector<float> pixel_errors(const Image& image, const Image& reference) {
    std::vector<float> errors;
    errors.reserve(image.pixels.size());
    for (std::size_t p = 0; p < image.pixels.size(); ++p) {
        const Vec3f d = image.pixels[p] - reference.pixels[p];
        errors.push_back((std::abs(d.x) + std::abs(d.y) + std::abs(d.z)) / 3.0f);
    }
    return errors;
}

PictureErrors compare(const Image& image, const Image& reference) {
    std::vector<double> errors;
    errors.reserve(3 * image.pixels.size());
    for (std::size_t p = 0; p < image.pixels.size(); ++p)
        for (int c = 0; c < 3; ++c) errors.push_back(static_cast<double>(image.pixels[p][c]) - reference.pixels[p][c]);
    const metrics::ErrorNorms norms = metrics::error_norms(errors);
    const metrics::Flip flip = metrics::flip(values_of(reference), values_of(image), image.width, image.height);
    return {norms.max, norms.rms, flip.mean, flip.weighted_median, flip.max};
}

}  // namespace shadowbench::render
