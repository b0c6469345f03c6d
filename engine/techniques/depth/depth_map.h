// The map that shadow_map and pcf share. Williams 1978; Reeves, Salesin, Cook 1987, section 3.1.
#pragma once

#include <limits>
#include <vector>

#include "techniques/cells.h"

namespace shadowbench::techniques {

// The nearest depth of every cell; `empty` where a ray crosses nothing. Whatever transmits less than everything counts
// as opaque; a medium counts from where it begins.
struct DepthMap {
    static constexpr float empty = std::numeric_limits<float>::max();

    Cells kind = Cells::sample;
    rays::MapLayout layout;
    CellGrid grid;
    std::vector<float> depth;

    void begin(const rays::MapLayout& map_layout);
    void add(const rays::LightRays& tile);
    std::size_t bytes() const { return depth.capacity() * sizeof(float); }
    NodeStats nodes() const;
    void stored(int x, int y, curves::Curve& out) const;
};

}  // namespace shadowbench::techniques
