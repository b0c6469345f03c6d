// The view rays of a camera.
#pragma once

#include "base/vec.h"

namespace shadowbench::scene {
struct Camera;
}

namespace shadowbench::rays {

// Image position (x, y) in pixels, (0, 0) the upper left corner: row 0 is the top of the picture.
struct ImagePlane {
    base::Vec3d origin;
    base::Vec3d corner, across, down;  // the ray of (x, y) runs along corner + x * across + y * down

    base::Vec3d through(double x, double y) const { return corner + across * x + down * y; }
    base::Vec3d direction(double x, double y) const { return through(x, y).normalized(); }
};

// Pixels are square; the camera's angle of view covers the image's height.
ImagePlane make_image_plane(const scene::Camera& camera, base::Vec2i resolution);

}  // namespace shadowbench::rays
