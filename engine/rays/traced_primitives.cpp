#include "rays/traced_primitives.h"

#include <algorithm>
#include <variant>

namespace shadowbench::rays {

using base::Vec3d;
using base::Vec3f;

bool hair_crossing(const Traced& traced, const scene::Hair& hair, unsigned segment, const TracedRay& ray, double& t) {
    const Vec3d origin = origin_beside(*traced.object, ray);
    const std::uint32_t first = traced.segments.first[segment];
    const double length2 = ray.direction.dot(ray.direction);
    const auto across = [&](const Vec3f& point, double& along) {
        const Vec3d p = Vec3d(point) - origin;
        along = p.dot(ray.direction) / length2;
        return p - ray.direction * along;
    };
    double ta, tb;
    const Vec3d a = across(hair.points[first], ta), b = across(hair.points[first + 1], tb);
    const double radius = traced.widened.empty() ? hair.radii[first] : traced.widened[first];
    if (traced.segments.joined[segment] && a.dot(a) <= radius * radius) return false;  // belongs to the earlier segment
    const Vec3d d = b - a;
    const double d2 = d.dot(d);
    const double u = d2 > 0.0 ? std::clamp(-a.dot(d) / d2, 0.0, 1.0) : 0.0;
    t = ta + (tb - ta) * u;
    return true;
}

float covered_share(const Traced& traced, const scene::Hair& hair, unsigned segment, float u) {
    if (traced.widened.empty()) return 1.0f;
    const std::uint32_t first = traced.segments.first[segment];
    const auto at = [&](const std::vector<float>& radii) { return radii[first] + u * (radii[first + 1] - radii[first]); };
    const float width = at(traced.widened);
    return width > 0.0f ? std::min(at(hair.radii) / width, 1.0f) : 1.0f;
}

Vec3f opacity_at(const scene::Object& object, const scene::Mesh& mesh, unsigned triangle, double u, double v) {
    if (!mesh.alpha) return object.opacity;
    const base::Vec2f* uv = &mesh.corner_uv[3 * static_cast<std::size_t>(triangle)];
    const base::Vec2f at =
        uv[0] * static_cast<float>(1.0 - u - v) + uv[1] * static_cast<float>(u) + uv[2] * static_cast<float>(v);
    return object.opacity * scene::sample(*mesh.alpha, at.x, at.y);
}

void triangle_depth(const scene::Object& object, const scene::Mesh& mesh, unsigned triangle, const TracedRay& ray,
                    double& t) {
    const base::Vec3i& index = mesh.triangles[triangle];
    const Vec3d p0(mesh.positions[index.x]);
    const Vec3d normal = (Vec3d(mesh.positions[index.y]) - p0).cross(Vec3d(mesh.positions[index.z]) - p0);
    if (const double facing = normal.dot(ray.direction); facing != 0.0)
        t = normal.dot(p0 - origin_beside(object, ray)) / facing;
}

Vec3d strand_direction(const Traced& traced, unsigned primitive) {
    const auto* hair = std::get_if<scene::Hair>(&traced.object->shape);
    if (!hair) return Vec3d(0.0);
    const std::uint32_t first = traced.segments.first[primitive];
    return (Vec3d(hair->points[first + 1]) - Vec3d(hair->points[first])).normalized();
}

double depth_of(const Traced& traced, unsigned primitive, const TracedRay& ray, double t) {
    if (const auto* mesh = std::get_if<scene::Mesh>(&traced.object->shape))
        triangle_depth(*traced.object, *mesh, primitive, ray, t);
    else if (const auto* hair = std::get_if<scene::Hair>(&traced.object->shape))
        hair_crossing(traced, *hair, primitive, ray, t);
    return t;
}

bool crosses_beside(const scene::Object& object, const scene::Mesh& mesh, unsigned triangle, const TracedRay& ray) {
    const Vec3d aside(0.5773, 0.3819, -0.7214);  // not along any edge that people model
    const Vec3d direction = ray.direction.normalized() + aside * 1e-9, origin = origin_beside(object, ray);
    const base::Vec3i& index = mesh.triangles[triangle];
    Vec3d corner[3];
    for (int i = 0; i < 3; ++i) corner[i] = Vec3d(mesh.positions[index[i]]) - origin;
    int left = 0;
    for (int i = 0; i < 3; ++i) left += direction.dot(corner[i].cross(corner[(i + 1) % 3])) > 0.0;
    return left == 0 || left == 3;
}

}  // namespace shadowbench::rays
