// Grids of voxels, rays through them, and their density by a plain lookup: what tests of marching share.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/random.h"
#include "base/vec.h"
#include "rays/march.h"
#include "scene/scene.h"

namespace shadowbench::rays::testing {

inline scene::GridVolume grid(base::Vec3i size, double step) {
    scene::GridVolume g;
    g.size = size;
    g.density.assign(static_cast<std::size_t>(size.x) * size.y * size.z, 0.0f);
    g.lower = {-1, -2, -3};
    g.upper = {2, 2, 3};
    g.step = step;
    return g;
}

inline float& at(scene::GridVolume& g, int x, int y, int z) {
    return g.density[(static_cast<std::size_t>(z) * g.size.y + y) * g.size.x + x];
}

inline double depth_of(const std::vector<MediumSegment>& segments) {
    double sum = 0.0;
    for (const MediumSegment& s : segments) sum += s.depth;
    return sum;
}

// Trilinear, without blocks.
inline double plain_density(const scene::GridVolume& g, const base::Vec3d& point) {
    double value = 0.0, place[3];
    for (int a = 0; a < 3; ++a)
        place[a] =
            std::clamp((point[a] - g.lower[a]) / (g.upper[a] - g.lower[a]) * g.size[a] - 0.5, 0.0, g.size[a] - 1.0);
    for (int c = 0; c < 8; ++c) {
        double weight = 1.0;
        int at[3];
        for (int a = 0; a < 3; ++a) {
            const int low = static_cast<int>(place[a]);
            weight *= c >> a & 1 ? place[a] - low : 1 - place[a] + low;
            at[a] = std::min(low + (c >> a & 1), g.size[a] - 1);
        }
        value += weight * g.density[(static_cast<std::size_t>(at[2]) * g.size.y + at[1]) * g.size.x + at[0]];
    }
    return value;
}

// With holes, empty blocks, and single voxels along an axis.
inline std::vector<scene::GridVolume> odd_grids() {
    base::Random random(8);
    std::vector<scene::GridVolume> grids;
    for (const base::Vec3i& size : {base::Vec3i(5, 4, 3), base::Vec3i(1, 1, 4), base::Vec3i(2, 1, 1),
                                    base::Vec3i(1, 1, 1), base::Vec3i(40, 37, 51)}) {
        grids.push_back(grid(size, 0.4));
        for (float& d : grids.back().density)
            d = static_cast<float>(std::max(0.0, random.uniform(size.x > 8 ? -40.0 : -0.5, 1.5)));
    }
    return grids;
}

// A ray through the box, sometimes along an axis or a diagonal of voxels.
struct Line {
    base::Vec3d origin, direction;
};
inline Line line_through(const scene::GridVolume& g, base::Random& random) {
    base::Vec3d target, d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    for (int a = 0; a < 3; ++a) target[a] = random.uniform(g.lower[a], g.upper[a]);
    switch (random.below(5)) {
        case 0:
            d[static_cast<int>(random.below(3))] = 0.0;
            break;
        case 1:
            d = base::Vec3d(0, 0, 0);
            d[static_cast<int>(random.below(3))] = random.below(2) ? 1.0 : -1.0;
            break;
        case 2:  // through corners of cells
            for (int a = 0; a < 3; ++a) {
                const double voxel = (g.upper[a] - g.lower[a]) / g.size[a];
                target[a] = g.lower[a] + (std::floor((target[a] - g.lower[a]) / voxel) + 0.5) * voxel;
                d[a] = voxel * (random.below(2) ? 1 : -1);
            }
            break;
        default:
            break;
    }
    d.normalize();
    return {target - d * 9.0, d};
}

}  // namespace shadowbench::rays::testing
