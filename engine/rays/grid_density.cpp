#include "rays/grid_density.h"

namespace shadowbench::rays {

void densities_at(const Voxels& voxels, const base::Vec3d& start, const base::Vec3d& slope, const Lanes& places,
                  Lanes& densities) {
    const double x = start.x, y = start.y, z = start.z, dx = slope.x, dy = slope.y, dz = slope.z;
    base::on_simd_path([=, s = places.data(), to = densities.data()]() SHADOWBENCH_SIMD_LOOP {
        double density[side_by_side];
        for (std::size_t i = 0; i < side_by_side; ++i)
            density[i] = density_at(voxels, x + dx * s[i], y + dy * s[i], z + dz * s[i]);
        for (std::size_t i = 0; i < side_by_side; ++i) to[i] = density[i];
    });
}

}  // namespace shadowbench::rays
