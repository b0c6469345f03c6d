#include "scene/readers/place_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"

namespace shadowbench::scene {
namespace {

// Densities of a grid, x fastest, at positions in voxels from the centre of the first one.
struct Sampled {
    Vec3i size;
    std::vector<float> density;

    double at(const Vec3d& place) const {
        Vec3i below(0, 0, 0);
        Vec3d share(0, 0, 0);  // of the voxel above, along each axis
        for (int axis = 0; axis < 3; ++axis) {
            if (!(place[axis] > -1.0 && place[axis] < size[axis])) return 0.0;
            const double whole = std::floor(place[axis]);
            below[axis] = static_cast<int>(whole);
            share[axis] = place[axis] - whole;
        }
        double sum = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            double weight = 1.0;
            std::size_t index = 0;
            for (int axis = 2; axis >= 0; --axis) {
                const int up = corner >> axis & 1, voxel = below[axis] + up;
                weight *= up ? share[axis] : 1.0 - share[axis];
                if (voxel < 0 || voxel >= size[axis]) weight = 0.0;
                if (weight == 0.0) break;
                index = index * static_cast<std::size_t>(size[axis]) + static_cast<std::size_t>(voxel);
            }
            if (weight > 0.0) sum += weight * static_cast<double>(density[index]);
        }
        return sum;
    }
};

// Points along the world's axes, from `first` on `begin` to `end` steps along each.
struct Lattice {
    std::array<Vec3d, 3> along;  // the way in the grid, in voxels, of one step along each world axis
    Vec3d step{0, 0, 0};         // world length
    Vec3d begin{0, 0, 0}, end{0, 0, 0};
};

// Empty if the steps are flat.
std::optional<Lattice> lattice_of(const std::array<Vec3d, 3>& steps, const Vec3i& size) {
    const double volume = steps[0].dot(steps[1].cross(steps[2]));
    Lattice lattice{};
    std::array<Vec3d, 3> gradient{steps[1].cross(steps[2]) / volume, steps[2].cross(steps[0]) / volume,
                                  steps[0].cross(steps[1]) / volume};  // of each grid coordinate
    constexpr double nothing = 1e-6;  // voxels, at which the density outside has all but ended
    for (int world = 0; world < 3; ++world) {
        const Vec3d way(gradient[0][world], gradient[1][world], gradient[2][world]);
        const double step = 1.0 / way.length();
        if (!std::isfinite(step) || !(step > 0.0)) return std::nullopt;
        double lower = 0.0, upper = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            const double back = -steps[i][world], on = size[static_cast<int>(i)] * steps[i][world];
            lower += std::min(back, on);
            upper += std::max(back, on);
        }
        lattice.along[static_cast<std::size_t>(world)] = way * step;
        lattice.step[world] = step;
        lattice.begin[world] = std::floor(lower / step + nothing) + 1.0;
        lattice.end[world] = std::ceil(upper / step - nothing);
    }
    return lattice;
}

void sample(const Sampled& grid, const Lattice& lattice, GridVolume& volume) {
    const auto row = static_cast<std::size_t>(volume.size.x), rows = static_cast<std::size_t>(volume.size.y);
    base::parallel_for(static_cast<std::size_t>(volume.size.z), [&](std::size_t z) {
        for (std::size_t y = 0; y < rows; ++y) {
            const Vec3d line = lattice.along[1] * (lattice.begin.y + static_cast<double>(y)) +
                               lattice.along[2] * (lattice.begin.z + static_cast<double>(z));
            float* const to = volume.density.data() + (z * rows + y) * row;
            for (std::size_t x = 0; x < row; ++x)
                to[x] =
                    static_cast<float>(grid.at(line + lattice.along[0] * (lattice.begin.x + static_cast<double>(x))));
        }
    });
}

std::optional<std::string> sample_along_world(GridVolume& volume, const GridPlace& place, std::uint64_t most_voxels) {
    const std::optional<Lattice> lattice = lattice_of(place.steps, volume.size);
    if (!lattice) return "the grid's transform flattens it";
    const Vec3d points = lattice->end - lattice->begin;
    if (!(points.x * points.y * points.z <= static_cast<double>(most_voxels)))
        return fmt::format(
            "the grid's transform shears it or turns it by other than right angles, and sampled along "
            "the world's axes it has {} x {} x {} voxels; the limit is {}",
            points.x, points.y, points.z, most_voxels);
    for (int axis = 0; axis < 3; ++axis) {
        const double step = lattice->step[axis];
        volume.lower[axis] = place.first ? (*place.first)[axis] + (lattice->begin[axis] - 0.5) * step : 0.0;
        volume.upper[axis] = volume.lower[axis] + points[axis] * step;
    }
    if (std::optional<std::string> fault = box_fault(volume)) return fault;

    const Sampled grid{volume.size, std::move(volume.density)};
    volume.size = Vec3i(points);
    volume.density.assign(static_cast<std::size_t>(points.x * points.y * points.z), 0.0f);
    sample(grid, *lattice, volume);
    volume.notes.lines.push_back(
        fmt::format("the grid's transform shears it or turns it by other than right angles: its {} x {} x {} voxels "
                    "are sampled along the world's axes",
                    grid.size.x, grid.size.y, grid.size.z));
    return std::nullopt;
}

}  // namespace

std::optional<std::string> place_grid(GridVolume& volume, const std::optional<GridAxes>& axes, const GridPlace& place,
                                      std::uint64_t most_voxels) {
    if (!axes) return sample_along_world(volume, place, most_voxels);
    set_box(volume, *axes, place.steps, place.first);
    return box_fault(volume);
}

}  // namespace shadowbench::scene
