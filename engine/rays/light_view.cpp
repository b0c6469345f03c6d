#include "rays/light_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "scene/scene.h"

namespace shadowbench::rays {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The light looks along `forward`; `right` is to its right. The map's y axis leans towards `up`, or towards the world's
// y axis.
void set_frame(LightView& view, const Vec3d& forward, const std::optional<Vec3d>& up) {
    view.forward = forward.normalized();
    Vec3d lean = up ? *up : Vec3d(0, 1, 0);
    if (view.forward.cross(lean).length() < 1e-6 * lean.length()) lean = Vec3d(0, 0, 1);
    view.right = view.forward.cross(lean).normalized();
    view.up = view.right.cross(view.forward);
}

std::array<Vec3d, 8> corners(const base::Box3d& box) {
    std::array<Vec3d, 8> result;
    for (int i = 0; i < 8; ++i)
        result[i] = {i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z};
    return result;
}

double largest(const Vec3d& place) {
    return std::max({std::abs(place.x), std::abs(place.y), std::abs(place.z)});
}

struct PlaneBounds {
    Vec2d low{infinity, infinity}, high{-infinity, -infinity};
    void add(double x, double y) {
        low = {std::min(low.x, x), std::min(low.y, y)};
        high = {std::max(high.x, x), std::max(high.y, y)};
    }
};

// Fits a map of square pixels, centred on `middle`, around `size`.
void fit(LightView& view, Vec2d middle, Vec2d size) {
    const double pixel = std::max(size.x / view.resolution.x, size.y / view.resolution.y);
    view.pixel = {pixel, pixel};
    view.lower = {middle.x - 0.5 * pixel * view.resolution.x, middle.y - 0.5 * pixel * view.resolution.y};
}

LightView directional_view(const scene::Light& light, const base::Box3d& casters, Vec2i resolution) {
    LightView view;
    view.resolution = resolution;
    view.z_near = -infinity;
    set_frame(view, light.direction, light.up);
    view.origin = light.target;

    PlaneBounds plane;
    double z_low = infinity, z_high = -infinity;
    for (const Vec3d& corner : corners(casters)) {
        const Vec3d p = to_view(view, corner);
        plane.add(p.x, p.y);
        z_low = std::min(z_low, p.z);
        z_high = std::max(z_high, p.z);
    }
    // Depth 0 lies slightly before the first caster: depths stay positive, and small, which keeps float z exact.
    const double scale = std::max({z_high - z_low, plane.high.x - plane.low.x, plane.high.y - plane.low.y, 1e-6});
    // More than the rounding of positions that far from the target; otherwise depths could fall below 0.
    const double rounding = 1e-12 * std::max(largest(casters.min), largest(casters.max) + largest(light.target));
    const double start = z_low - std::max(0.01 * scale, rounding);
    view.origin += view.forward * start;
    view.z_min = z_low - start;
    view.z_max = z_high - start;

    if (light.extent) {
        view.pixel = {light.extent->x / resolution.x, light.extent->y / resolution.y};
        view.lower = {-0.5 * light.extent->x, -0.5 * light.extent->y};
    } else {
        const Vec2d size = plane.high - plane.low;
        fit(view, (plane.low + plane.high) * 0.5, {1.04 * size.x + 1e-3 * scale, 1.04 * size.y + 1e-3 * scale});
    }
    return view;
}

LightView spot_view(const scene::Light& light, const base::Box3d& casters, Vec2i resolution, const std::string& where) {
    LightView view;
    view.perspective = true;
    view.resolution = resolution;
    view.origin = light.position;
    const Vec3d axis = light.target - light.position;
    set_frame(view, axis, light.up);
    view.z_near = light.near > 0 ? light.near : 1e-3 * axis.length();

    double z_low = infinity, z_high = -infinity, slope_x = 0, slope_y = 0;
    for (const Vec3d& corner : corners(casters)) {
        const Vec3d p = to_view(view, corner);
        z_low = std::min(z_low, p.z);
        z_high = std::max(z_high, p.z);
        slope_x = std::max(slope_x, p.z > 0 ? std::abs(p.x / p.z) : infinity);
        slope_y = std::max(slope_y, p.z > 0 ? std::abs(p.y / p.z) : infinity);
    }
    view.z_min = std::max(z_low, view.z_near);
    view.z_max = z_high;
    if (z_high <= view.z_near) {  // all casters are behind the light: use depths around its target
        view.z_min = view.z_near;
        view.z_max = 2.0 * std::max(axis.length(), view.z_near);
    }

    if (light.face) {
        view.face = *light.face;
        fit(view, {0, 0}, {2.0 * (1.0 + light.border), 2.0 * (1.0 + light.border)});
    } else if (light.angle) {
        const double half = std::tan(*light.angle * std::numbers::pi / 360.0);
        const double pixel = 2.0 * half / std::max(resolution.x, resolution.y);
        fit(view, {0, 0}, {pixel * resolution.x, pixel * resolution.y});
    } else {
        const double widest = std::tan(85.0 * std::numbers::pi / 180.0);
        if (slope_x > widest || slope_y > widest)
            throw base::Error(base::ErrorCode::bad_input, where + "/angle",
                              "the casters reach beside or behind the light, so no angle fits them: give \"angle\"");
        fit(view, {0, 0}, {2.04 * slope_x + 1e-6, 2.04 * slope_y + 1e-6});
    }
    return view;
}

LightView deep_image_view(const scene::DeepImage& image) {
    LightView view;
    view.resolution = {image.width, image.height};
    view.z_near = -infinity;
    view.z_min = infinity;
    view.z_max = -infinity;
    for (std::size_t s = 0; s < image.z_front.size(); ++s) {
        if (scene::behind_everything(image, s)) continue;
        view.z_min = std::min<double>(view.z_min, image.z_front[s]);
        view.z_max = std::max<double>(view.z_max, image.z_back[s]);
    }
    return view;
}

// Refuses volumes whose voxels distances from the light, in double, cannot resolve.
void check_volumes(const LightView& view, const scene::Scene& scene, const std::string& where) {
    constexpr double farthest = 1e13;  // in voxels
    for (const scene::Object& object : scene.objects) {
        const auto* volume = std::get_if<scene::GridVolume>(&object.shape);
        if (!volume || !object.casts_shadow) continue;
        const base::Box3d box = scene::world_box(*volume);
        const double away = std::max({largest(box.min - view.origin), largest(box.max - view.origin), largest(box.min),
                                      largest(box.max), largest(view.origin)});
        if (away > farthest * scene::voxel_width(*volume))
            throw base::Error(base::ErrorCode::bad_input, where,
                              "the light, or the world's origin, is more than 1e13 voxels away from the volume \"" +
                                  object.name + "\": bring them nearer or make the voxels larger");
    }
}

}  // namespace

LightView make_light_view(const scene::Light& light, const scene::Scene& scene, Vec2i resolution,
                          const std::string& where) {
    if (light.type == scene::LightType::deep_image) return deep_image_view(*scene.deep_image);
    const base::Box3d casters = scene::bounds(scene, true);
    if (casters.isEmpty()) throw base::Error(base::ErrorCode::bad_input, where, "nothing in the scene casts a shadow");
    const LightView view = light.type == scene::LightType::spot ? spot_view(light, casters, resolution, where)
                                                                : directional_view(light, casters, resolution);
    check_volumes(view, scene, where);
    return view;
}

// True if all corners are outside one of the map's sides, or none is behind the near plane.
bool misses_all(const LightView& view, const scene::Scene& scene) {
    if (scene.deep_image) return false;
    const Vec2d high = view.lower + Vec2d(view.pixel.x * view.resolution.x, view.pixel.y * view.resolution.y);
    int left = 0, right = 0, below = 0, above = 0, before = 0;
    for (const Vec3d& corner : corners(scene::bounds(scene, true))) {
        const Vec3d p = to_view(view, corner);
        const double w = view.perspective ? p.z : 1.0;  // sides are planes through the light: x < lower * z, ...
        left += p.x < view.lower.x * w;
        right += p.x > high.x * w;
        below += p.y < view.lower.y * w;
        above += p.y > high.y * w;
        before += p.z <= view.z_near;
    }
    return left == 8 || right == 8 || below == 8 || above == 8 || before == 8;
}

Vec3d to_view(const LightView& view, const Vec3d& world) {
    const Vec3d d = world - view.origin;
    return {d.dot(view.right), d.dot(view.up), d.dot(view.forward)};
}

Vec3d to_world(const LightView& view, const Vec3d& p) {
    return view.origin + view.right * p.x + view.up * p.y + view.forward * p.z;
}

Vec3d to_light(const LightView& view, const Vec3d& world) {
    const Vec3d p = to_view(view, world);
    const double w = view.perspective ? p.z : 1.0;
    return {(p.x / w - view.lower.x) / view.pixel.x, (p.y / w - view.lower.y) / view.pixel.y, p.z};
}

Vec3d unproject(const LightView& view, double x, double y, double z) {
    const double w = view.perspective ? z : 1.0;
    return {(view.lower.x + x * view.pixel.x) * w, (view.lower.y + y * view.pixel.y) * w, z};
}

LightLine light_line(const LightView& view, double x, double y) {
    const double px = view.lower.x + x * view.pixel.x, py = view.lower.y + y * view.pixel.y;
    const Vec3d aside = view.right * px + view.up * py;
    constexpr double far_before = -1e30;  // before everything
    if (!view.perspective) return {view.origin + aside, view.forward, 1.0, std::max(view.z_near, far_before)};
    return {view.origin, aside + view.forward, std::sqrt(1.0 + px * px + py * py), view.z_near};
}

double length_per_depth(const LightView& view, double x, double y) {
    if (!view.perspective) return 1.0;
    const double sx = view.lower.x + x * view.pixel.x, sy = view.lower.y + y * view.pixel.y;
    return std::sqrt(1.0 + sx * sx + sy * sy);
}

}  // namespace shadowbench::rays
