#include "rays/moving.h"

#include <algorithm>

namespace shadowbench::rays {

Placed place_sphere(const LightView& view, const base::Vec3f& centre, double radius, const Vec3d& offset) {
    const Vec3d c = Vec3d(centre) + offset;
    Placed placed{{}, c.z - radius, c.z + radius};
    if (placed.z_low > view.z_near) add_sphere(view, c, radius, placed.box);
    return placed;
}

Placed place_triangle(const LightView& view, const base::Vec3f& a, const base::Vec3f& b, const base::Vec3f& c,
                      const Vec3d& offset) {
    const Vec3d v0 = Vec3d(a) + offset, v1 = Vec3d(b) + offset, v2 = Vec3d(c) + offset;
    Placed placed{{}, std::min({v0.z, v1.z, v2.z}), std::max({v0.z, v1.z, v2.z})};
    if (placed.z_low > view.z_near) add_triangle(view, v0, v1, v2, placed.box);
    return placed;
}

Placed place_hair(const LightView& view, const HairSegment& s, const Vec3d& offset) {
    const Vec3d a = Vec3d(s.a) + offset, b = Vec3d(s.b) + offset;
    Placed placed{{}, std::min(a.z - s.radius_a, b.z - s.radius_b), std::max(a.z + s.radius_a, b.z + s.radius_b)};
    if (placed.z_low > view.z_near) {
        add_sphere(view, a, s.radius_a, placed.box);
        add_sphere(view, b, s.radius_b, placed.box);
    }
    return placed;
}

PlaneBox swept(const LightView& view, const Placed& from, const Placed& to) {
    PlaneBox box;
    if (std::min(from.z_low, to.z_low) > view.z_near) {
        // A view-plane position, also x / z, moves monotonically while z > 0, so the boxes at both ends bound the way.
        box.add(from.box);
        box.add(to.box);
    } else if (std::max(from.z_high, to.z_high) > view.z_near) {
        box.add_all();
    }
    return box;
}

}  // namespace shadowbench::rays
