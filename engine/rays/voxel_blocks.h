// Where a grid has density: blocks of 4^3 cells, each with its distance to the nearest block that is not empty.
#pragma once

#include <cstddef>
#include <vector>

#include "base/vec.h"

namespace shadowbench::scene {
struct GridVolume;
}

namespace shadowbench::rays {

class VoxelBlocks {
public:
    explicit VoxelBlocks(const scene::GridVolume& volume);

    // If the block around `index`, in voxel coordinates, is empty, how far a ray surely stays in empty blocks, in units
    // of `slope`; infinite if that is 0. Otherwise 0.
    double empty_ahead(const base::Vec3d& index, const base::Vec3d& slope) const;

    std::size_t bytes() const { return distance_.capacity(); }

private:
    void mark_occupied(const scene::GridVolume& volume);
    void find_distances();
    std::size_t number(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(blocks_.y) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(blocks_.x) +
               static_cast<std::size_t>(x);
    }

    base::Vec3i blocks_;
    // The number of blocks, along the axis where it is largest, to the nearest block in which some corner of a cell has
    // density; at most 255.
    std::vector<unsigned char> distance_;
};

}  // namespace shadowbench::rays
