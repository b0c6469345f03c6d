#include "render/default_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "rays/tracer.h"
#include "render/shading.h"

namespace shadowbench::render {
namespace {

using base::Vec3d;

constexpr double filled = 0.92;          // share of the picture's sides that what is to be seen takes
constexpr double furthest_shadow = 3.0;  // times the casters' size
constexpr double height = 0.55;          // of the eye, over the ground that it stands away
constexpr int rounds = 6;                // of moving what is to be seen into the middle

std::vector<Vec3d> corners_of(const base::Box3d& box) {
    std::vector<Vec3d> corners;
    for (int i = 0; i < 8; ++i)
        corners.emplace_back(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                             i & 4 ? box.max.z : box.min.z);
    return corners;
}

// How far a ray from a corner of the box runs inside it.
double way_inside(const base::Box3d& box, const Vec3d& corner, const Vec3d& direction) {
    double way = std::numeric_limits<double>::infinity();
    for (int a = 0; a < 3; ++a)
        if (direction[a] != 0.0)
            way = std::min(way, ((direction[a] > 0.0 ? box.max[a] : box.min[a]) - corner[a]) / direction[a]);
    return way;
}

// Adds where the light that passes the corners of the casters ends behind them.
void add_shadows(const scene::Light& light, const base::Box3d& casters, const rays::Tracer& tracer,
                 std::vector<Vec3d>& places) {
    const double size = casters.size().length();
    std::vector<rays::SurfaceHit> hits;
    for (const Vec3d& corner : corners_of(casters)) {
        const Vec3d direction = -towards(light, corner);
        if (direction == Vec3d(0.0)) continue;  // the light is at the corner
        const Vec3d start = corner + direction * (way_inside(casters, corner, direction) + 1e-6 * size);
        if (tracer.surfaces(start, direction, hits, scene::mid_shutter))
            places.push_back(start + direction * std::min(hits.back().t, furthest_shadow * size));
    }
}

// From the casters to the eye. `travels`: the way of the light.
Vec3d way_to_eye(const Vec3d& travels) {
    const Vec3d usual(3.0, 2.5, 4.0), flat(travels.x, 0.0, travels.z);
    if (flat.length() < 0.1 * travels.length()) return usual.normalized();
    const Vec3d along = flat.normalized(), beside(along.z, 0.0, -along.x);
    const Vec3d side = beside.dot(usual) < 0.0 ? -beside : beside;
    return (0.5 * along + std::sqrt(0.75) * side + Vec3d(0.0, height, 0.0)).normalized();
}

// The nearest camera of this direction, and with this target, that sees all places inside `filled` of its picture.
// Then moves the target to the middle of what it sees.
void fit(std::span<const Vec3d> places, const Vec3d& to_eye, double aspect, scene::Camera& camera) {
    const Vec3d right = camera.up.cross(to_eye).normalized(), up = to_eye.cross(right);
    const double half_y = std::tan(0.5 * camera.fov * std::numbers::pi / 180.0), half_x = half_y * aspect;
    for (int turn = 0; turn < rounds; ++turn) {
        double distance = 1e-6;
        for (const Vec3d& place : places) {
            const Vec3d p = place - camera.target;
            const double wanted = std::max(std::abs(p.dot(right)) / half_x, std::abs(p.dot(up)) / half_y) / filled;
            distance = std::max(distance, p.dot(to_eye) + wanted);
        }
        camera.position = camera.target + to_eye * distance;
        if (turn + 1 == rounds) return;
        double low[2], high[2];
        std::fill(low, low + 2, std::numeric_limits<double>::infinity());
        std::fill(high, high + 2, -std::numeric_limits<double>::infinity());
        for (const Vec3d& place : places) {
            const Vec3d p = place - camera.target;
            const double depth = std::max(distance - p.dot(to_eye), 1e-9);
            const double seen[2] = {p.dot(right) / depth, p.dot(up) / depth};
            for (int a = 0; a < 2; ++a) {
                low[a] = std::min(low[a], seen[a]);
                high[a] = std::max(high[a], seen[a]);
            }
        }
        camera.target += (right * (0.5 * (low[0] + high[0])) + up * (0.5 * (low[1] + high[1]))) * distance;
    }
}

}  // namespace

scene::Camera default_camera(const scene::Scene& scene) {
    const base::Box3d box = scene::bounds(scene, true);
    scene::Camera camera;
    camera.target = box.center();
    const double radius = 0.5 * box.size().length();
    const double distance = 1.05 * radius / std::sin(camera.fov * std::numbers::pi / 360.0);
    camera.position = camera.target + Vec3d(3.0, 2.5, 4.0).normalized() * std::max(distance, 1e-6);
    return camera;
}

scene::Camera camera_of_shadows(const scene::Scenario& scenario, base::Vec2i size, const rays::Tracer& tracer) {
    scene::Camera camera = default_camera(scenario.scene);
    const base::Box3d casters = scene::bounds(scenario.scene, true);
    if (scenario.lights.empty() || casters.isEmpty()) return camera;
    std::vector<Vec3d> places = corners_of(casters);
    for (const scene::Light& light : scenario.lights) add_shadows(light, casters, tracer, places);
    base::Box3d all;
    for (const Vec3d& place : places) all.extendBy(place);
    camera.target = all.center();
    fit(places, way_to_eye(-towards(scenario.lights.front(), camera.target)), static_cast<double>(size.x) / size.y,
        camera);
    return camera;
}

}  // namespace shadowbench::render
