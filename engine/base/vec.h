// Vectors and boxes, from Imath. A box is empty when constructed (isEmpty() holds) and grows by extendBy().
#pragma once

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

namespace shadowbench::base {

using Vec2i = Imath::V2i;
using Vec3i = Imath::V3i;
using Vec2f = Imath::V2f;
using Vec3f = Imath::V3f;
using Vec2d = Imath::V2d;
using Vec3d = Imath::V3d;
using Box3d = Imath::Box3d;

}  // namespace shadowbench::base
