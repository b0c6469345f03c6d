#include "scene/readers/grid_axes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scene/limits.h"

namespace shadowbench::scene {
namespace {

// Off-axis entries relative to the entry of the axis, and how far they move a voxel of the box at most, in voxels.
constexpr double most_skew = 1e-5, most_shift = 0.1;

std::size_t index(int axis) {
    return static_cast<std::size_t>(axis);
}

}  // namespace

std::string text_of(const GridAxes& axes) {
    std::string text;
    for (std::size_t i = 0; i < 3; ++i)
        text += fmt::format("{}{}{}", i > 0 ? ", " : "", axes.mirrored[i] ? "-" : "", "xyz"[axes.to[i]]);
    return text;
}

std::optional<GridAxes> find_axes(const std::array<Vec3d, 3>& steps, const Vec3i& size) {
    GridAxes axes;
    for (std::size_t i = 0; i < 3; ++i)
        for (int world = 0; world < 3; ++world)
            if (std::abs(steps[i][world]) > std::abs(steps[i][axes.to[i]])) axes.to[i] = world;
    const auto along = [&](std::size_t i) { return steps[i][axes.to[i]]; };
    for (std::size_t i = 0; i < 3; ++i) {
        axes.mirrored[i] = along(i) < 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            if (k == i) continue;
            const double beside = std::abs(steps[i][axes.to[k]]);
            if (beside > most_skew * std::abs(along(i)) ||
                beside * size[static_cast<int>(i)] > most_shift * std::abs(along(k)))
                return std::nullopt;
        }
    }
    return axes;
}

Vec3i turned(const Vec3i& size, const GridAxes& axes) {
    Vec3i result(0, 0, 0);
    for (int i = 0; i < 3; ++i) result[axes.to[index(i)]] = size[i];
    return result;
}

TurnedSteps turned_steps(const Vec3i& size, const GridAxes& axes) {
    const Vec3i world = turned(size, axes);
    const std::array<std::ptrdiff_t, 3> strides{1, world.x, std::ptrdiff_t{world.x} * world.y};
    TurnedSteps steps;
    for (int i = 0; i < 3; ++i) {
        const std::ptrdiff_t stride = strides[index(axes.to[index(i)])];
        steps.step[index(i)] = axes.mirrored[index(i)] ? -stride : stride;
        if (axes.mirrored[index(i)]) steps.first += stride * (size[i] - 1);
    }
    return steps;
}

TurnedPlaces::TurnedPlaces(const Vec3i& size, const GridAxes& axes)
    : size_(size), steps_(turned_steps(size, axes)), place_(steps_.first) {}

std::size_t TurnedPlaces::next() {
    const auto place = static_cast<std::size_t>(place_);
    for (int i = 0; i < 3; ++i) {
        place_ += steps_.step[index(i)];
        if (++at_[i] < size_[i]) break;
        place_ -= steps_.step[index(i)] * size_[i];
        at_[i] = 0;
    }
    return place;
}

void set_box(GridVolume& volume, const GridAxes& axes, const std::array<Vec3d, 3>& steps,
             const std::optional<Vec3d>& first) {
    for (std::size_t i = 0; i < 3; ++i) {
        const int world = axes.to[i];
        const double step = steps[i][world], length = std::abs(step) * volume.size[world];
        const double begin = first ? (*first)[world] - 0.5 * step : 0.0;
        volume.lower[world] = first && step < 0.0 ? begin - length : begin;
        volume.upper[world] = volume.lower[world] + length;
    }
}

std::optional<std::string> box_fault(const Vec3d& from, const Vec3d& to) {
    for (int axis = 0; axis < 3; ++axis) {
        const double lower = from[axis], upper = to[axis];
        if (!(std::abs(lower) <= max_coordinate) || !(std::abs(upper) <= max_coordinate) ||
            !(upper - lower >= min_length))
            return fmt::format(
                "the grid's world box runs from {} to {} along an axis; both must be finite, at most {} "
                "from 0 and {} apart at least",
                lower, upper, max_coordinate, min_length);
    }
    return std::nullopt;
}

}  // namespace shadowbench::scene
