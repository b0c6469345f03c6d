// The density of a grid between its voxel centres.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "base/simd_path.h"

namespace shadowbench::rays {

// Voxels, x fastest; fewer than 2^31.
struct Voxels {
    const float* density;
    int size_x, size_y, size_z;
};

// The lower corner of the cell around a place along an axis with `count` voxels; -1 before the first centre.
SHADOWBENCH_SIMD_LOOP inline int cell_of(double place, int count) {
    return std::min(static_cast<int>(place + 1.0), count) - 1;  // floor, as places are >= -1
}

// Trilinear at voxel coordinates (voxel centres at whole numbers) inside the box. The box ends half a voxel outside the
// outermost centres, where the outermost value holds.
inline double density_at(const Voxels& voxels, double at_x, double at_y, double at_z) {
    const int x = cell_of(at_x, voxels.size_x), y = cell_of(at_y, voxels.size_y), z = cell_of(at_z, voxels.size_z);
    const int x0 = std::max(x, 0), x1 = std::min(x + 1, voxels.size_x - 1);
    const int y0 = std::max(y, 0), y1 = std::min(y + 1, voxels.size_y - 1);
    const int z0 = std::max(z, 0), z1 = std::min(z + 1, voxels.size_z - 1);
    const double fx = at_x - x, fy = at_y - y, fz = at_z - z;
    const auto row = [&](int yy, int zz) {
        const int begin = (zz * voxels.size_y + yy) * voxels.size_x;
        const double low = voxels.density[begin + x0], high = voxels.density[begin + x1];
        return low + fx * (high - low);
    };
    const double r00 = row(y0, z0), r01 = row(y0, z1), r10 = row(y1, z0), r11 = row(y1, z1);
    const double a = r00 + fy * (r10 - r00), b = r01 + fy * (r11 - r01);
    return std::max(a + fz * (b - a), 0.0);
}

// So many places are evaluated side by side.
inline constexpr std::size_t side_by_side = 16;
template <class T>
using Lanes = std::array<T, side_by_side>;

// The bits of two voxels that are neighbours along x.
struct VoxelPair {
    std::uint32_t first, second;
};

// The density within a pair. A cell at the grid's end is half outside, where the outermost voxel holds for both: then
// `before` or `behind` has all bits set, else none. It chooses by bits, since GCC makes a branch, and no vectors, of a
// choice between floats in memory.
SHADOWBENCH_SIMD_LOOP inline double within_pair(const VoxelPair& pair, std::uint32_t before, std::uint32_t behind,
                                                double share) {
    const std::uint32_t other = pair.first ^ pair.second;
    const double low = std::bit_cast<float>(pair.first ^ (other & behind));
    const double high = std::bit_cast<float>(pair.second ^ (other & before));
    return low + share * (high - low);
}

// The same as density_at, with the same bits, for a grid at least two voxels wide. GCC makes vectors of all loops but
// that of the loads.
SHADOWBENCH_SIMD_LOOP inline void densities_at(const Voxels& voxels, const Lanes<double>& at_x,
                                               const Lanes<double>& at_y, const Lanes<double>& at_z,
                                               Lanes<double>& densities) {
    const int nx = voxels.size_x, ny = voxels.size_y, nz = voxels.size_z;
    double share_x[side_by_side], share_y[side_by_side], share_z[side_by_side];
    std::uint32_t before[side_by_side], behind[side_by_side];
    int offset[4][side_by_side];  // of the rows (y, z), (y + 1, z), (y, z + 1), (y + 1, z + 1)
    for (std::size_t i = 0; i < side_by_side; ++i) {
        const int x = cell_of(at_x[i], nx), y = cell_of(at_y[i], ny), z = cell_of(at_z[i], nz);
        share_x[i] = at_x[i] - x;
        share_y[i] = at_y[i] - y;
        share_z[i] = at_z[i] - z;
        const int column = std::min(std::max(x, 0), nx - 2);
        before[i] = x < column ? ~0u : 0u;
        behind[i] = x > column ? ~0u : 0u;
        const int y0 = std::max(y, 0), y1 = std::min(y + 1, ny - 1);
        const int z0 = std::max(z, 0) * ny, z1 = std::min(z + 1, nz - 1) * ny;
        offset[0][i] = (z0 + y0) * nx + column;
        offset[1][i] = (z0 + y1) * nx + column;
        offset[2][i] = (z1 + y0) * nx + column;
        offset[3][i] = (z1 + y1) * nx + column;
    }
    VoxelPair pairs[4][side_by_side];
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t i = 0; i < side_by_side; ++i)
            std::memcpy(&pairs[row][i], voxels.density + offset[row][i], sizeof(VoxelPair));
    for (std::size_t i = 0; i < side_by_side; ++i) {
        const auto row = [&](std::size_t r) SHADOWBENCH_SIMD_LOOP {
            return within_pair(pairs[r][i], before[i], behind[i], share_x[i]);
        };
        const double r00 = row(0), r10 = row(1), r01 = row(2), r11 = row(3);
        const double a = r00 + share_y[i] * (r10 - r00), b = r01 + share_y[i] * (r11 - r01);
        const double density = a + share_z[i] * (b - a);
        densities[i] = density > 0.0 ? density : 0.0;
    }
}

}  // namespace shadowbench::rays
