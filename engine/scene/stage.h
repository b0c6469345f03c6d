// Places a ground, a light and a camera around a box, for scenarios that are made from files.
#pragma once

#include "scene/scene.h"

namespace shadowbench::scene {

enum class UpAxis { y, z };

inline constexpr int picture_width = 384, picture_height = 288;  // pixels
inline constexpr double picture_aspect = static_cast<double>(picture_width) / picture_height;

// All numbers are rounded to a thousandth of the box's size, or shorter.
struct Stage {
    Vec3d ground_corner{0, 0, 0}, ground_u{0, 0, 0}, ground_v{0, 0, 0};  // a square, below the box by a gap
    Vec3d light{0, 0, 0};  // the direction in which it travels: oblique, so that the shadow falls beside the box
    Camera camera;         // sees all of the box and of its shadow on the ground, in a picture of this aspect or wider
    double bias = 0.0;     // a thousandth of the box's diagonal
};

// The diagonal of the box must be above 0, and the box finite.
Stage stage_around(const Box3d& box, UpAxis up);

// The optical depth, for an extinction of 1, through the densest column of voxels along the axis where that is least.
// So a slab, or a column of smoke, is seen from all sides.
double densest_column(const GridVolume& volume);

// The number with this many digits that is nearest; 0 stays 0.
double to_digits(double value, int digits);

}  // namespace shadowbench::scene
