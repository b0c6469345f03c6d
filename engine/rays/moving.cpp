#include "rays/moving.h"

#include <algorithm>

namespace shadowbench::rays {

Placed place_sphere(const LightView& view, const base::Vec3f& centre, double radius, const Vec3d& offset) {
    const Vec3d c = Vec3d(centre) + offset;
    Placed placed{{}, c.z - radius, c.z + radius, {c}, 1, radius};
    if (placed.z_low > view.z_near) add_sphere(view, c, radius, placed.box);
    return placed;
}

Placed place_triangle(const LightView& view, const base::Vec3f& a, const base::Vec3f& b, const base::Vec3f& c,
                      const Vec3d& offset) {
    const Vec3d v0 = Vec3d(a) + offset, v1 = Vec3d(b) + offset, v2 = Vec3d(c) + offset;
    Placed placed{{}, std::min({v0.z, v1.z, v2.z}), std::max({v0.z, v1.z, v2.z}), {v0, v1, v2}, 3, 0.0};
    if (placed.z_low > view.z_near) add_triangle(view, v0, v1, v2, placed.box);
    return placed;
}

Placed place_hair(const LightView& view, const HairSegment& s, const Vec3d& offset) {
    const Vec3d a = Vec3d(s.a) + offset, b = Vec3d(s.b) + offset;
    Placed placed{{},
                  std::min(a.z - s.radius_a, b.z - s.radius_b),
                  std::max(a.z + s.radius_a, b.z + s.radius_b),
                  {a, b},
                  2,
                  std::max(s.radius_a, s.radius_b)};
    if (placed.z_low > view.z_near) add_hair(view, a, s.radius_a, b, s.radius_b, placed.box);
    return placed;
}

PlaneBox swept(const LightView& view, const Placed& from, const Placed& to) {
    PlaneBox box;
    if (std::min(from.z_low, to.z_low) > view.z_near) {
        // A view-plane position, also x / z, moves monotonically while z > 0, so the boxes at both ends bound the way.
        box.add(from.box);
        box.add(to.box);
    } else if (std::max(from.z_high, to.z_high) > view.z_near) {
        std::array<Vec3d, 6> both;
        const auto first = both.begin();
        const auto second = std::copy_n(from.points.begin(), from.count, first);
        const auto end = std::copy_n(to.points.begin(), to.count, second);
        add_across_near(view, {first, end}, from.radius, box);
    }
    return box;
}

}  // namespace shadowbench::rays
