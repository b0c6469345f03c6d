#include "render/picture_size.h"

#include <algorithm>
#include <cmath>

namespace shadowbench::render {

base::Vec2i enlarged(base::Vec2i size) {
    const double width = usual_width, factor = std::min({width / size.x, 2.0 * width / size.y, most_enlarged});
    if (factor <= 1.0) return size;
    const auto scaled = [factor](int side) { return std::max(static_cast<int>(std::lround(factor * side)), 1); };
    return {scaled(size.x), scaled(size.y)};
}

}  // namespace shadowbench::render
