// Pictures made ready for print: exposed, in front of grey, numbered, side by side.
#pragma once

#include <span>

#include "render/image.h"

namespace shadowbench::claims {

// The factor by which a picture is printed brighter: with it, the brightest channel of 99 % of the pixels that show
// something is at most 0.9, as linear light. `seen`: the share of each pixel that shows something. 1 if all are black.
double print_exposure(const render::Image& picture, std::span<const float> seen);

// The picture times `exposure`; what is not seen is grey instead of black, so that both bright and dark outlines show.
render::Image on_grey(const render::Image& picture, std::span<const float> seen, double exposure);

// White where a difference is 0, black where it is 1 or more: the negative of the picture that a display would show, so
// that small differences show as well as in bright on black.
render::Image dark_on_white(const render::Image& difference);

// Two pictures, one above the other.
struct Panel {
    render::Image above, below;
};

// Panels from left to right, all of one size, numbered from 1 in the lower left corner of the upper picture.
render::Image side_by_side(std::span<const Panel> panels);

}  // namespace shadowbench::claims
