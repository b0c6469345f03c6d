// The density of a grid between its voxel centres.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "base/simd_path.h"
#include "base/vec.h"

namespace shadowbench::rays {

// Voxels, x fastest; fewer than 2^31.
struct Voxels {
    const float* density;
    int size_x, size_y, size_z;
};

// Trilinear at voxel coordinates (voxel centres at whole numbers) inside the box. The box ends half a voxel outside the
// outermost centres, where the outermost value holds.
SHADOWBENCH_SIMD_LOOP inline double density_at(const Voxels& voxels, double at_x, double at_y, double at_z) {
    const auto floor_within = [](double place, int count) SHADOWBENCH_SIMD_LOOP {  // for places >= -1
        return std::min(static_cast<int>(place + 1.0), count) - 1;
    };
    const int x = floor_within(at_x, voxels.size_x), y = floor_within(at_y, voxels.size_y);
    const int z = floor_within(at_z, voxels.size_z);
    const int x0 = std::max(x, 0), x1 = std::min(x + 1, voxels.size_x - 1);
    const int y0 = std::max(y, 0), y1 = std::min(y + 1, voxels.size_y - 1);
    const int z0 = std::max(z, 0), z1 = std::min(z + 1, voxels.size_z - 1);
    const double fx = at_x - x, fy = at_y - y, fz = at_z - z;
    const auto row = [&](int yy, int zz) SHADOWBENCH_SIMD_LOOP {
        const int begin = (zz * voxels.size_y + yy) * voxels.size_x;
        const double low = voxels.density[begin + x0], high = voxels.density[begin + x1];
        return low + fx * (high - low);
    };
    const double r00 = row(y0, z0), r01 = row(y0, z1), r10 = row(y1, z0), r11 = row(y1, z1);
    const double a = r00 + fy * (r10 - r00), b = r01 + fy * (r11 - r01);
    return std::max(a + fz * (b - a), 0.0);
}

// So many places of one ray are evaluated side by side.
inline constexpr std::size_t side_by_side = 16;
using Lanes = std::array<double, side_by_side>;

// The densities at start + slope * s for each s of `places`, with the same bits as density_at.
void densities_at(const Voxels& voxels, const base::Vec3d& start, const base::Vec3d& slope, const Lanes& places,
                  Lanes& densities);

}  // namespace shadowbench::rays
