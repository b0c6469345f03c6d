// Light rays and stored functions as the samples of a deep image, after Interpreting OpenEXR Deep Pixels (Hillman and
// Welford 2013): a sample from z_front to z_back takes alpha of the light; a surface has both at one depth. Between its
// ends a sample's transmittance is (1 - alpha)^t, t the share of the way.
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
    std::vector<float> alpha;  // channels a sample, in [0, 1]
};

// One ray a pixel: its segments as they are. More rays: the samples of the pixel's visibility function, whose media are
// joined by lines that err by at most 1e-4.
DeepBlock samples_of_rays(const rays::LightRays& tile);

// Appends samples that have the functions' values, one function a channel, at all of their vertices and just behind
// each: a step is a surface, a slope a medium between its two vertices. So the medium is exponential where the function
// is a line, and meets it at both ends. What a function loses before its first vertex stands as a surface at `front`,
// or just before that vertex if that is nearer. The functions must not rise by more than rounding: returns false, with
// nothing appended, when one does.
bool append_function(std::span<const curves::Curve> functions, float front, DeepBlock& block);

// Size of the image of a finished technique's maps: one pixel a cell. They must store functions.
base::Vec2i size_of(const bench::Maps& maps);

// Row `y` of the cells, all channels. A function that is not piecewise linear is sampled at 64 depths of the layout's
// range besides its own nodes. Throws Error{bad_input} for one that rises, which a deep image cannot hold.
DeepBlock samples_of_functions(const bench::Maps& maps, int y);

}  // namespace shadowbench::render
