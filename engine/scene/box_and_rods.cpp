#include <cmath>

#include "scene/fill_grid.h"
#include "scene/procedural.h"

namespace shadowbench::scene {

GridVolume make_density_box(const DensityBox& parameters) {
    return fill_grid(parameters.size, parameters.lower, parameters.upper, [](const Vec3d& at) {
        return static_cast<float>(1.0 - std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}));
    });
}

GridVolume make_crossed_rods(const CrossedRods& parameters) {
    const Vec3d half = 0.5 * (parameters.upper - parameters.lower);
    const double square = parameters.radius * parameters.radius;
    return fill_grid(parameters.size, parameters.lower, parameters.upper, [&](const Vec3d& at) {
        const Vec3d way = at * half;  // from the middle of the box, world length
        const double x = way.x * way.x, y = way.y * way.y, z = way.z * way.z;
        return x + y <= square || y + z <= square || z + x <= square ? 1.0f : 0.0f;
    });
}

}  // namespace shadowbench::scene
