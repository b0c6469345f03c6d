// Grids whose axes run along the world's in another order, or backwards.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "scene/scene.h"

namespace shadowbench::scene {

struct GridAxes {
    std::array<int, 3> to{0, 1, 2};  // the world axis along which each axis of the grid runs
    std::array<bool, 3> mirrored{false, false, false};

    bool as_they_are() const { return to == std::array{0, 1, 2} && mirrored == std::array{false, false, false}; }
};

// As "x, -z, y".
std::string text_of(const GridAxes& axes);

// From the steps in the world of one voxel along each axis of a grid of `size` voxels, which are finite and not 0.
// Empty if they shear the grid, or turn it by other than right angles, by more than the rounding of float matrices and
// of short values of pi.
std::optional<GridAxes> find_axes(const std::array<Vec3d, 3>& steps, const Vec3i& size);

// The size along the world's axes.
Vec3i turned(const Vec3i& size, const GridAxes& axes);

// Voxel (i, j, k) of a grid goes to first + i * step[0] + j * step[1] + k * step[2] in one whose axes are the world's.
struct TurnedSteps {
    std::ptrdiff_t first = 0;
    std::array<std::ptrdiff_t, 3> step{};
};
TurnedSteps turned_steps(const Vec3i& size, const GridAxes& axes);

// The same for all voxels of a grid, x fastest, in turn.
class TurnedPlaces {
public:
    TurnedPlaces(const Vec3i& size, const GridAxes& axes);

    std::size_t next();

private:
    Vec3i size_;
    TurnedSteps steps_;
    Vec3i at_{0, 0, 0};
    std::ptrdiff_t place_;
};

// Sets the box of a volume from the steps of its file's grid. `first` is the centre of the file's first voxel; without
// it the box begins at the origin.
void set_box(GridVolume& volume, const GridAxes& axes, const std::array<Vec3d, 3>& steps,
             const std::optional<Vec3d>& first);

// What is wrong with the box of a volume, if anything: it is not finite, too large, or has no length.
std::optional<std::string> box_fault(const Vec3d& lower, const Vec3d& upper);

}  // namespace shadowbench::scene
