// The transforms of pbrt's statements. A matrix of Imath transforms row vectors, so a * b applies a first; 16 numbers
// of a pbrt file are its rows.
#pragma once

#include <optional>
#include <vector>

#include <Imath/ImathMatrix.h>

#include "scene/scene.h"

namespace shadowbench::scene {

using Matrix = Imath::M44d;

Matrix translation(const Vec3d& by);
Matrix scaling(const Vec3d& by);
// By degrees, counter-clockwise around the axis.
Matrix rotation(double degrees, const Vec3d& axis);
// From the world to a camera that looks along z, with x to the right.
std::optional<Matrix> looking(const Vec3d& from, const Vec3d& at, const Vec3d& up);

// Whether the numbers are finite, and parallel lines stay parallel.
bool is_affine(const Matrix& matrix);

Vec3d transform_point(const Matrix& matrix, const Vec3d& point);
Vec3d transform_direction(const Matrix& matrix, const Vec3d& direction);

// The cube root of how much volumes grow: what widths grow by, exactly if all lengths grow by the same.
double mean_scale(const Matrix& matrix);
// Whether all lengths grow by the same, but for rounding.
bool is_uniform(const Matrix& matrix);

}  // namespace shadowbench::scene
