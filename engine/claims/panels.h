// Pictures made ready for print: numbered, side by side.
#pragma once

#include <span>

#include "render/image.h"

namespace shadowbench::claims {

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
