// Fills grids of density from a function of position.
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/parallel.h"
#include "scene/scene.h"

namespace shadowbench::scene {

// A grid of `size` voxels over the box from `lower` to `upper`; its step is half of the smallest voxel edge. The
// density of a voxel is density(at), where `at` is its centre in coordinates in which the box is [-1, 1]^3. Calls
// density from several threads.
template <class Density>
GridVolume fill_grid(const Vec3i& size, const Vec3d& lower, const Vec3d& upper, const Density& density) {
    const auto width = static_cast<std::size_t>(size.x), height = static_cast<std::size_t>(size.y);
    const auto depth = static_cast<std::size_t>(size.z);
    const Vec3d extent = upper - lower;

    GridVolume volume;
    volume.size = size;
    volume.lower = lower;
    volume.upper = upper;
    volume.step = 0.5 * std::min({extent.x / size.x, extent.y / size.y, extent.z / size.z});
    volume.density.resize(width * height * depth);
    base::parallel_for(depth, [&](std::size_t z) {
        for (std::size_t y = 0; y < height; ++y)
            for (std::size_t x = 0; x < width; ++x) {
                const Vec3d at((2.0 * static_cast<double>(x) + 1.0) / size.x - 1.0,
                               (2.0 * static_cast<double>(y) + 1.0) / size.y - 1.0,
                               (2.0 * static_cast<double>(z) + 1.0) / size.z - 1.0);
                volume.density[(z * height + y) * width + x] = density(at);
            }
    });
    return volume;
}

}  // namespace shadowbench::scene
