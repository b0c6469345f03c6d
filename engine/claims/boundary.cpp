#include "claims/boundary.h"

#include <cstddef>
#include <numbers>

namespace shadowbench::claims {

double boundary_length(std::span<const Shade> pixels, base::Vec2i size) {
    const auto at = [&](int x, int y) {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(x)];
    };
    const auto differ = [](Shade a, Shade b) { return a != b && a != Shade::unseen && b != Shade::unseen; };
    double crossings = 0.0;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            if (x + 1 < size.x) crossings += differ(at(x, y), at(x + 1, y));
            if (y + 1 < size.y) crossings += differ(at(x, y), at(x, y + 1));
        }
    return 0.25 * std::numbers::pi * crossings;
}

}  // namespace shadowbench::claims
