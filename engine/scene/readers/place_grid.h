// The place of a file's grid in the world, whatever its transform.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "scene/readers/grid_axes.h"
#include "scene/scene.h"

namespace shadowbench::scene {

// The steps in the world of one voxel along each axis of a grid, and the centre of its first voxel; without that, the
// box begins at the origin.
struct GridPlace {
    std::array<Vec3d, 3> steps{Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)};
    std::optional<Vec3d> first;
};

// Sets the box of a volume with the densities of a grid.
//
// With axes, those of find_axes(), the densities stand in the world's order already. Without them, they stand in the
// grid's, x fastest, and are sampled at points along the world's axes: trilinear between voxel centres, falling to 0
// over the width of a voxel outside the outermost ones, which keeps the integral of the density. One step between
// points moves by one voxel in the grid; the centre of the first voxel is a point. A note says so. The densities are
// then held twice for a while.
//
// Returns what is wrong with the transform, if anything, or that there are more than `most_voxels` points.
std::optional<std::string> place_grid(GridVolume& volume, const std::optional<GridAxes>& axes, const GridPlace& place,
                                      std::uint64_t most_voxels);

}  // namespace shadowbench::scene
