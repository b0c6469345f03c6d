// The faces of a cube along the world's axes around a light that shines in all directions: +x, -x, +y, -y, +z, -z.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "base/vec.h"

namespace shadowbench::scene {

inline constexpr std::array cube_faces{"+x", "-x", "+y", "-y", "+z", "-z"};

// Where each face looks.
inline base::Vec3d face_direction(int face) {
    base::Vec3d direction(0.0);
    direction[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
    return direction;
}

// The face that a direction from the light meets; on a seam the axis that comes first, so that every direction has one
// face.
inline int cube_face(const base::Vec3d& direction) {
    int axis = 0;
    for (const int other : {1, 2})
        if (std::abs(direction[other]) > std::abs(direction[axis])) axis = other;
    return 2 * axis + (direction[axis] < 0.0);
}

}  // namespace shadowbench::scene
