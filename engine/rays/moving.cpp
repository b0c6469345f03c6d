#include "rays/moving.h"

#include <algorithm>

namespace shadowbench::rays {
namespace {

// Of a primitive between depths z_low and z_high that add_at(offset, box) bounds at one place. In front of the near
// plane everything's place on the view plane runs one way, x / z too, so the ends bound the way between.
template <class AddAt>
PlaneBox swept(const LightView& view, double z_low, double z_high, const Vec3d& from, const Vec3d& to,
               const AddAt& add_at) {
    PlaneBox box;
    if (view.perspective && z_low + std::min(from.z, to.z) <= view.z_near) {
        if (z_high + std::max(from.z, to.z) > view.z_near) box.add_all();
        return box;
    }
    add_at(from, box);
    add_at(to, box);
    return box;
}

}  // namespace

PlaneBox swept_sphere(const LightView& view, const base::Vec3f& centre, double radius, const Vec3d& from,
                      const Vec3d& to) {
    const Vec3d c(centre);
    return swept(view, c.z - radius, c.z + radius, from, to,
                 [&](const Vec3d& offset, PlaneBox& box) { add_sphere(view, c + offset, radius, box); });
}

PlaneBox swept_triangle(const LightView& view, const base::Vec3f& a, const base::Vec3f& b, const base::Vec3f& c,
                        const Vec3d& from, const Vec3d& to) {
    const Vec3d v0(a), v1(b), v2(c);
    return swept(
        view, std::min({v0.z, v1.z, v2.z}), std::max({v0.z, v1.z, v2.z}), from, to,
        [&](const Vec3d& offset, PlaneBox& box) { add_triangle(view, v0 + offset, v1 + offset, v2 + offset, box); });
}

PlaneBox swept_hair(const LightView& view, const HairSegment& s, const Vec3d& from, const Vec3d& to) {
    const Vec3d a(s.a), b(s.b);
    return swept(view, std::min(a.z - s.radius_a, b.z - s.radius_b), std::max(a.z + s.radius_a, b.z + s.radius_b), from,
                 to, [&](const Vec3d& offset, PlaneBox& box) {
                     add_sphere(view, a + offset, s.radius_a, box);
                     add_sphere(view, b + offset, s.radius_b, box);
                 });
}

}  // namespace shadowbench::rays
