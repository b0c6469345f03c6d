#include <cstddef>

#include "base/random.h"
#include "scene/procedural.h"
#include "scene/turn.h"

namespace shadowbench::scene {

Particles make_smoke_column(const SmokeColumn& parameters) {
    const auto count = static_cast<std::size_t>(parameters.particles);
    const double phase = base::to_unit(base::hash(parameters.seed, 1));
    Particles smoke;
    smoke.centres.reserve(count);
    smoke.radii.reserve(count);
    smoke.density.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        base::Random random(base::hash(parameters.seed, 2, i));
        const double rise = (static_cast<double>(i) + random.uniform()) / static_cast<double>(count);
        const double half_width = 0.5 * parameters.width * (1.0 + 2.0 * rise);
        // The whole column winds around its axis, more with height.
        const Turn wind = turn(phase + 1.5 * rise);
        const Vec2d in_column = in_disc(random);
        const double x = half_width * (0.75 * in_column.x + 0.25 * wind.cosine);
        const double z = half_width * (0.75 * in_column.y + 0.25 * wind.sine);
        smoke.centres.emplace_back(parameters.base + Vec3d(x, parameters.height * rise, z));
        smoke.radii.push_back(static_cast<float>(parameters.puff_radius * (1.0 + rise) * random.uniform(0.8, 1.2)));
        smoke.density.push_back(static_cast<float>(parameters.density * (1.0 - 0.75 * rise)));
    }
    return smoke;
}

}  // namespace shadowbench::scene
