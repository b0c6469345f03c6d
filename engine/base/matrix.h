// Affine maps, from Imath: a point is a row that is multiplied from the left, so translations are in the last row.
#pragma once

#include <Imath/ImathMatrix.h>

#include "base/vec.h"

namespace shadowbench::base {

using Matrix4d = Imath::M44d;

inline Vec3d map_point(const Matrix4d& matrix, const Vec3d& point) {
    Vec3d result;
    matrix.multVecMatrix(point, result);
    return result;
}

inline Vec3d map_direction(const Matrix4d& matrix, const Vec3d& direction) {
    Vec3d result;
    matrix.multDirMatrix(direction, result);
    return result;
}

}  // namespace shadowbench::base
