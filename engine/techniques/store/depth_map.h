// The nearest depth of every cell, from which shadow_map, pcf and multi_depth are built. Williams 1978; Reeves,
// Salesin, Cook 1987, section 3.1.
#pragma once

#include <vector>

#include "techniques/store/depth_store.h"

namespace shadowbench::techniques {

// The map under construction: `no_depth` where a ray crosses nothing. Every surface that absorbs anything counts as
// opaque; a medium counts from where it begins.
struct DepthMap {
    Cells kind = Cells::sample;
    rays::MapLayout layout;
    CellGrid grid;
    std::vector<float> depth;  // row after row

    void begin(const rays::MapLayout& map_layout);
    void add(const rays::LightRays& tile);
};

// A map of one stored depth per cell, for techniques that keep no more.
struct StoredDepths {
    DepthMap map;  // empty once finished
    Storage way = Storage::raw;
    DepthStore store;

    explicit StoredDepths(const ParameterValues& values);
    // For Technique::least_bytes.
    static std::size_t least_bytes(const ParameterValues& values, const rays::MapLayout& layout);
    void finish();
    std::size_t working_bytes() const;  // the map and the stored depths together, before the map is freed
    void stored(int x, int y, curves::Curve& out) const;
};

// The function of sorted depths: a step of 1/n down at each, none at no_depth.
void steps_of(const float* depths, int n, curves::Curve& out);

}  // namespace shadowbench::techniques
