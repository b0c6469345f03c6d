// How bright a picture is shown. All pictures of one set share the exposure of their reference.
#pragma once

#include <span>

#include "render/image.h"

namespace shadowbench::render {

// The factor by which a picture is shown brighter: with it, the brightest channel of 99 % of the pixels that show
// something is at most 0.9, as linear light. `seen`: the share of each pixel that shows something. 1 if all are black.
double exposure_of(const Image& picture, std::span<const float> seen);

// The picture times `exposure`; what is not seen is grey instead of black, so that both bright and dark outlines show.
Image on_grey(const Image& picture, std::span<const float> seen, double exposure);

}  // namespace shadowbench::render
