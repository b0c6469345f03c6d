#include "bench/seen_places.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <variant>

namespace shadowbench::bench {
namespace {

using base::Vec3d;

constexpr std::size_t most_places = 4096;
constexpr std::size_t most_a_side = 32;  // places along a side of a triangle

// Calls visit(i) for at most most_places of `count` primitives, spread evenly.
template <class Visit>
void for_some(std::size_t count, const Visit& visit) {
    const std::size_t some = std::min(count, most_places);
    for (std::size_t i = 0; i < some; ++i) visit(i * count / some);
}

// Few triangles have many places each, at the middles of the smaller triangles that they are divided into.
template <class Visit>
void for_places(const scene::Mesh& mesh, const Visit& visit) {
    std::size_t sides = 1;
    while (sides < most_a_side && 4 * sides * sides * mesh.triangles.size() <= most_places) sides *= 2;
    for_some(mesh.triangles.size(), [&](std::size_t t) {
        const base::Vec3i& corners = mesh.triangles[t];
        const auto corner = [&](int c) { return Vec3d(mesh.positions[static_cast<std::size_t>(c)]); };
        const Vec3d a = corner(corners.x), ab = corner(corners.y) - a, ac = corner(corners.z) - a;
        const double area = ab.cross(ac).length(), n = static_cast<double>(sides);
        for (std::size_t i = 0; i < sides; ++i)
            for (std::size_t j = 0; i + j < sides; ++j)
                visit(a + ab * ((static_cast<double>(i) + 1.0 / 3.0) / n) +
                          ac * ((static_cast<double>(j) + 1.0 / 3.0) / n),
                      area);
    });
}

template <class Visit>
void for_places(const scene::Hair& hair, const Visit& visit) {
    for_some(hair.points.size(), [&](std::size_t i) { visit(Vec3d(hair.points[i]), 1.0); });
}

template <class Balls, class Visit>
void for_centres(const Balls& balls, const Visit& visit) {
    for_some(balls.centres.size(), [&](std::size_t i) {
        const double r = static_cast<double>(balls.radii[i]);
        visit(Vec3d(balls.centres[i]), r * r);
    });
}

template <class Visit>
void for_places(const scene::Spheres& spheres, const Visit& visit) {
    for_centres(spheres, visit);
}

template <class Visit>
void for_places(const scene::Particles& particles, const Visit& visit) {
    for_centres(particles, visit);
}

template <class Visit>
void for_places(const scene::GridVolume& grid, const Visit& visit) {
    const Vec3d box = grid.upper - grid.lower;
    const auto x = static_cast<std::size_t>(grid.size.x), y = static_cast<std::size_t>(grid.size.y);
    const auto middle = [](std::size_t voxel, int size) { return (static_cast<double>(voxel) + 0.5) / size; };
    for_some(grid.density.size(), [&](std::size_t i) {
        if (!(grid.density[i] > 0.0f)) return;
        const Vec3d share(middle(i % x, grid.size.x), middle(i / x % y, grid.size.y), middle(i / (x * y), grid.size.z));
        const Vec3d at = grid.lower + Vec3d(share.x * box.x, share.y * box.y, share.z * box.z);
        visit(grid.frame ? base::map_point(grid.frame->to_world, at) : at, 1.0);
    });
}

bool holds(const rays::LightView& view, const Vec3d& place) {
    const Vec3d at = rays::to_light(view, place);
    if (view.perspective && !(at.z > std::max(view.z_near, 0.0))) return false;
    return at.x >= 0.0 && at.x <= view.resolution.x && at.y >= 0.0 && at.y <= view.resolution.y;
}

}  // namespace

double share_in_map(const scene::Object& object, const rays::LightView& camera, const rays::LightView& light) {
    double seen = 0.0, in_map = 0.0;
    const auto add = [&](const Vec3d& place, double size) {
        if (!holds(camera, place)) return;
        const double z = rays::to_light(camera, place).z, weight = size / (z * z);
        seen += weight;
        if (holds(light, place)) in_map += weight;
    };
    std::visit([&](const auto& shape) { for_places(shape, add); }, object.shape);
    return seen > 0.0 ? in_map / seen : 1.0;
}

double seen_share_of_map(const scene::Scene& scene, const rays::LightView& camera, const rays::LightView& light) {
    constexpr int side = 16;
    std::array<bool, side * side> seen{};
    std::size_t places = 0;
    const auto add = [&](const Vec3d& place, double) {
        if (!holds(camera, place) || !holds(light, place)) return;
        ++places;
        const Vec3d at = rays::to_light(light, place);
        const auto cell = [](double pixel, int pixels) {
            return std::min(side - 1, static_cast<int>(side * pixel / pixels));
        };
        seen[static_cast<std::size_t>(side * cell(at.y, light.resolution.y) + cell(at.x, light.resolution.x))] = true;
    };
    for (const scene::Object& object : scene.objects)
        std::visit([&](const auto& shape) { for_places(shape, add); }, object.shape);
    return places < seen.size() ? 1.0 : static_cast<double>(std::count(seen.begin(), seen.end(), true)) / seen.size();
}

}  // namespace shadowbench::bench
