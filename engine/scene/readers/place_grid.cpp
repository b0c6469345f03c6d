#include "scene/readers/place_grid.h"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>

namespace shadowbench::scene {
namespace {

// The grid's own space has its first corner at the origin, and edges of voxels as long as in the world.
std::optional<std::string> place_in_own_space(GridVolume& volume, const GridPlace& place) {
    constexpr double flattest = 1e-6;  // the volume that three steps of length 1 span
    base::Matrix4d to_world;
    std::array<Vec3d, 3> way;
    Vec3d corner = place.first.value_or(Vec3d(0, 0, 0));
    volume.lower = Vec3d(0, 0, 0);
    for (int i = 0; i < 3; ++i) {
        const auto axis = static_cast<std::size_t>(i);
        const double length = place.steps[axis].length();
        volume.upper[i] = length * volume.size[i];
        way[axis] = place.steps[axis] / length;
        corner -= 0.5 * place.steps[axis];
        for (int world = 0; world < 3; ++world) to_world[i][world] = way[axis][world];
    }
    if (std::optional<std::string> fault = box_fault(volume.lower, volume.upper)) return fault;
    if (!(std::abs(way[0].dot(way[1].cross(way[2]))) >= flattest)) return "the grid's transform flattens it";
    for (int world = 0; world < 3; ++world) to_world[3][world] = corner[world];
    volume.frame = GridFrame{to_world, to_world.inverse()};
    if (!place.first) {
        const Vec3d to_origin = -world_box(volume).min;
        base::Matrix4d move;
        for (int world = 0; world < 3; ++world) move[3][world] = to_origin[world];
        scene::place(volume, move);
    }
    const Box3d box = world_box(volume);
    return box_fault(box.min, box.max);
}

}  // namespace

std::string text_of(const std::optional<GridAxes>& axes, const GridPlace& place) {
    if (axes) return axes->as_they_are() ? "" : text_of(*axes);
    std::string text;
    for (const Vec3d& step : place.steps) {
        const Vec3d way = step / step.length();
        text += fmt::format("{}({:.4g}, {:.4g}, {:.4g})", text.empty() ? "" : ", ", way.x, way.y, way.z);
    }
    return text;
}

std::optional<std::string> place_grid(GridVolume& volume, const std::optional<GridAxes>& axes, const GridPlace& place) {
    if (!axes) return place_in_own_space(volume, place);
    set_box(volume, *axes, place.steps, place.first);
    return box_fault(volume.lower, volume.upper);
}

}  // namespace shadowbench::scene
