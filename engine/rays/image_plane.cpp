#include "rays/image_plane.h"

#include <cmath>
#include <numbers>

#include "scene/scene.h"

namespace shadowbench::rays {

using base::Vec3d;

ImagePlane make_image_plane(const scene::Camera& camera, base::Vec2i resolution) {
    const Vec3d forward = (camera.target - camera.position).normalized();
    Vec3d right = forward.cross(camera.up);
    if (right.length() < 1e-9 * camera.up.length()) right = forward.cross(Vec3d(forward.z, forward.x, forward.y));
    right.normalize();
    const Vec3d up = right.cross(forward);
    const double pixel = 2.0 * std::tan(camera.fov * std::numbers::pi / 360.0) / resolution.y;
    return {camera.position, forward - right * (0.5 * pixel * resolution.x) + up * (0.5 * pixel * resolution.y),
            right * pixel, -up * pixel};
}

}  // namespace shadowbench::rays
