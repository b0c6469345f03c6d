// Converts light rays and stored functions to the samples of a deep image, after Interpreting OpenEXR Deep Pixels
// (Hillman and Welford 2013): a sample from z_front to z_back absorbs the share alpha of the light; a surface has both
// at one depth. Within a sample the transmittance is (1 - alpha)^t, t the share of the way from front to back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "bench/maps.h"
#include "curves/curve.h"
#include "rays/light_rays.h"

namespace shadowbench::render {

// The samples of a rectangle of pixels.
struct DeepBlock {
    int x0 = 0, y0 = 0, width = 0, height = 0;
    int channels = 1;                     // 1 or 3
    std::vector<std::uint64_t> begin{0};  // width * height + 1 offsets into the samples, row after row
    std::vector<float> z_front, z_back;
    std::vector<float> alpha;  // `channels` values per sample, in [0, 1]
};

// For one ray a pixel: its segments, unchanged. For more rays: samples of the pixel's visibility function, in which
// media are approximated by lines that err by at most 1e-4.
DeepBlock samples_of_rays(const rays::LightRays& tile);

// Appends samples that have the values of the functions, one per channel, at all their vertices and just behind each. A
// step becomes a surface, a slope a medium between its two vertices; so the medium is exponential where the function is
// a line, and meets it at both ends. What a function loses before its first vertex becomes a surface at `front`, or
// just before that vertex if that is nearer. The functions must not rise by more than rounding: if one does, returns
// false and appends nothing.
bool append_function(std::span<const curves::Curve> functions, float front, DeepBlock& block);

// Size of the image of a finished technique's maps: one pixel per cell. The maps must store functions.
base::Vec2i size_of(const bench::Maps& maps);

// Row `y` of the cells, all channels. A function that is not piecewise linear is sampled at its own nodes and at 64
// depths of the layout's range. Throws Error{bad_input} for a function that rises, which a deep image cannot hold.
DeepBlock samples_of_functions(const bench::Maps& maps, int y);

}  // namespace shadowbench::render
