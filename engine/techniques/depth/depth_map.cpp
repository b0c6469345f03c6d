#include "techniques/depth/depth_map.h"

namespace shadowbench::techniques {

void DepthMap::begin(const rays::MapLayout& map_layout) {
    layout = map_layout;
    grid = make_cells(layout, kind);
    depth.assign(grid.count(), empty);
}

void DepthMap::add(const rays::LightRays& tile) {
    for_each_cell(layout, grid, kind, tile, [&](std::size_t cell, std::size_t ray) {
        for (std::uint32_t s = tile.begin[ray]; s < tile.begin[ray + 1]; ++s)
            if (tile.transmittance[s] < 1.0f) {
                depth[cell] = tile.z_front[s];
                break;
            }
    });
}

NodeStats DepthMap::nodes() const {
    NodeStats stats;
    for (const float z : depth) stats.add(z == empty ? 0 : 1);
    return stats;
}

void DepthMap::stored(int x, int y, curves::Curve& out) const {
    out.clear();
    const float z = depth[grid.index(x, y)];
    if (z != empty) out = {{z, 1.0f}, {z, 0.0f}};
}

}  // namespace shadowbench::techniques
