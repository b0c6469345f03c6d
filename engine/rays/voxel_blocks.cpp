#include "rays/voxel_blocks.h"

#include <algorithm>
#include <limits>

#include "scene/scene.h"

namespace shadowbench::rays {
namespace {

constexpr int block_size = 4;
constexpr int farthest = 255;

}  // namespace

VoxelBlocks::VoxelBlocks(const scene::GridVolume& volume) {
    // Block b holds the interpolation cells whose lower corner index + 1 lies in [4 b, 4 b + 4); indices run from -1 to
    // size - 1.
    blocks_ = {volume.size.x / block_size + 1, volume.size.y / block_size + 1, volume.size.z / block_size + 1};
    distance_.assign(number(0, 0, blocks_.z), farthest);
    mark_occupied(volume);
    find_distances();
}

void VoxelBlocks::mark_occupied(const scene::GridVolume& volume) {
    std::size_t v = 0;
    for (int z = 0; z < volume.size.z; ++z)
        for (int y = 0; y < volume.size.y; ++y)
            for (int x = 0; x < volume.size.x; ++x, ++v) {
                if (volume.density[v] <= 0.0f) continue;
                // A voxel is a corner of the cells at its own index and at the index below, in each axis.
                for (int bz = z / block_size; bz <= (z + 1) / block_size; ++bz)
                    for (int by = y / block_size; by <= (y + 1) / block_size; ++by)
                        for (int bx = x / block_size; bx <= (x + 1) / block_size; ++bx)
                            distance_[number(bx, by, bz)] = 0;
            }
}

// Two passes, each in the order of its neighbours' numbers, find chessboard distances exactly (Borgefors, Distance
// transformations in arbitrary dimensions, 1984).
void VoxelBlocks::find_distances() {
    const auto relax = [&](int x, int y, int z, int side) {  // from the 13 neighbours before (-1) or behind (1)
        int least = distance_[number(x, y, z)];
        for (int dz = 0; dz <= 1; ++dz)
            for (int dy = dz == 0 ? 0 : -1; dy <= 1; ++dy)
                for (int dx = dz == 0 && dy == 0 ? 1 : -1; dx <= 1; ++dx) {
                    const int nx = x + side * dx, ny = y + side * dy, nz = z + side * dz;
                    if (nx < 0 || nx >= blocks_.x || ny < 0 || ny >= blocks_.y || nz < 0 || nz >= blocks_.z) continue;
                    least = std::min(least, distance_[number(nx, ny, nz)] + 1);
                }
        distance_[number(x, y, z)] = static_cast<unsigned char>(least);
    };
    for (int z = 0; z < blocks_.z; ++z)
        for (int y = 0; y < blocks_.y; ++y)
            for (int x = 0; x < blocks_.x; ++x) relax(x, y, z, -1);
    for (int z = blocks_.z; z-- > 0;)
        for (int y = blocks_.y; y-- > 0;)
            for (int x = blocks_.x; x-- > 0;) relax(x, y, z, 1);
}

double VoxelBlocks::empty_ahead(const base::Vec3d& index, const base::Vec3d& slope) const {
    base::Vec3i block;
    for (int a = 0; a < 3; ++a) block[a] = std::clamp(static_cast<int>(index[a] + 1.0) / block_size, 0, blocks_[a] - 1);
    const int distance = distance_[number(block.x, block.y, block.z)];
    if (distance == 0) return 0.0;
    double ahead = std::numeric_limits<double>::infinity();
    for (int a = 0; a < 3; ++a) {
        if (slope[a] == 0.0) continue;
        const double wall = (slope[a] > 0.0 ? block[a] + distance : block[a] - distance + 1) * block_size - 1;
        ahead = std::min(ahead, (wall - index[a]) / slope[a]);
    }
    return ahead;
}

}  // namespace shadowbench::rays
