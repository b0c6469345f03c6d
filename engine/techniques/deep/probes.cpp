#include "techniques/deep/probes.h"

#include <algorithm>
#include <cmath>

namespace shadowbench::techniques {
namespace {

constexpr double largest = 1e30;   // map pixels: wider than any map, and far from the ends of a float
constexpr double rounding = 1e-6;  // of a ratio: so little above a whole number adds no probe

}  // namespace

bool probes_of(const Footprint& f, int most, Probes& out) {
    if (!f.known() || !std::isfinite(f.ux) || !std::isfinite(f.uy) || !std::isfinite(f.vx) || !std::isfinite(f.vy))
        return false;
    // The singular values are q + r and |q - r| (in double: the difference is small for thin parallelograms).
    const double e = 0.5 * (static_cast<double>(f.ux) + f.vy), g = 0.5 * (static_cast<double>(f.ux) - f.vy);
    const double h = 0.5 * (static_cast<double>(f.uy) + f.vx), k = 0.5 * (static_cast<double>(f.uy) - f.vx);
    const double q = std::hypot(e, k), r = std::hypot(g, h);
    const double longer = std::min(q + r, largest), shorter = std::abs(q - r);
    const double narrowest = std::max(shorter, std::min(longer, 1.0));
    const double wanted = std::min(std::ceil(longer / narrowest - rounding), static_cast<double>(most));
    const int count = std::max(static_cast<int>(wanted), 1);
    const double width = std::max(longer / count, std::min(narrowest, longer));
    out = {count, static_cast<float>(width), 0.0f, 0.0f};
    if (count == 1) return true;
    const double angle = 0.5 * (std::atan2(k, e) + std::atan2(h, g));
    const double step = std::sqrt(std::max(longer * longer - width * width, 0.0) / (count * count - 1.0));
    out.step_x = static_cast<float>(step * std::cos(angle));
    out.step_y = static_cast<float>(step * std::sin(angle));
    return true;
}

}  // namespace shadowbench::techniques
