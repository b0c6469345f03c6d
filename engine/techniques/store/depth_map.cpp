#include "techniques/store/depth_map.h"

#include <utility>

namespace shadowbench::techniques {

void DepthMap::begin(const rays::MapLayout& map_layout) {
    layout = map_layout;
    grid = make_cells(layout, kind);
    depth.assign(grid.count(), no_depth);
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

StoredDepths::StoredDepths(const ParameterValues& values) : way(read_storage(values)) {
    map.kind = read_cells(values);
}

std::size_t StoredDepths::least_bytes(const ParameterValues& values, const rays::MapLayout& layout) {
    return least_store_bytes(read_storage(values), make_cells(layout, read_cells(values)), 1);
}

void StoredDepths::finish() {
    store.keep(way, map.grid, 1, std::move(map.depth));
}

std::size_t StoredDepths::working_bytes() const {
    const std::size_t raw = map.grid.count() * sizeof(float);
    return way == Storage::raw ? raw : raw + store.bytes();
}

void StoredDepths::stored(int x, int y, curves::Curve& out) const {
    steps_of(store.at(x, y), 1, out);
}

void steps_of(const float* depths, int n, curves::Curve& out) {
    out.clear();
    for (int i = 0; i < n && depths[i] != no_depth; ++i) {
        const float before = static_cast<float>(n - i) / static_cast<float>(n);
        const float behind = static_cast<float>(n - i - 1) / static_cast<float>(n);
        if (!out.empty() && out.back().z == depths[i]) {  // one step for all equal depths
            out.back().value = behind;
        } else {
            out.push_back({depths[i], before});
            out.push_back({depths[i], behind});
        }
    }
}

}  // namespace shadowbench::techniques
