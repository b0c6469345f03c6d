// The place of a file's grid in the world, whatever its transform.
#pragma once

#include <array>
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

// The world directions of a grid's axes, for people: "x, -z, y" of those of find_axes(), empty if they are as they are;
// without them vectors of length 1.
std::string text_of(const std::optional<GridAxes>& axes, const GridPlace& place);

// Sets where a volume with the size and densities of a grid lies.
//
// With axes, those of find_axes(), the densities stand in the world's order already, and the volume's box stands along
// the world's axes. Without them, they stand in the grid's, x fastest, and rays enter the grid's own space: the volume
// gets a frame, and no density changes.
//
// Returns what is wrong with the transform, if anything.
std::optional<std::string> place_grid(GridVolume& volume, const std::optional<GridAxes>& axes, const GridPlace& place);

}  // namespace shadowbench::scene
