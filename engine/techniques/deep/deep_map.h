// The compressed pixels of a deep shadow map, their building and their lookup. Lokovic and Veach 2000, section 3.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "techniques/cells.h"
#include "techniques/deep/deep_level.h"

namespace shadowbench::techniques {

struct DeepMap {
    float tolerance = 0.0f;
    bool tent = false;  // lookup kernel: a tent twice as wide as the footprint, else a box
    CellGrid grid;
    std::vector<DeepLevel> levels = std::vector<DeepLevel>(1);
    std::size_t peak_bytes = 0;

    void begin(const rays::MapLayout& map_layout);
    void add(const rays::LightRays& tile);
    void finish();

    void lookup(std::span<const Query> queries, std::span<float> visibility) const;
    void touched(const Query& q, std::vector<const void*>& lines) const;
    std::size_t bytes() const { return levels[0].bytes(); }
    NodeStats stats() const;
    void stored(int x, int y, curves::Curve& out) const;

private:
    struct TileNodes {
        int x0 = 0, y0 = 0, width = 0;
        std::vector<std::uint32_t> begin;  // pixels + 1
        std::vector<curves::Vertex> vertices;
        std::size_t scratch_bytes = 0;
    };
    rays::MapLayout layout_;
    std::vector<TileNodes> tiles_;
};

// The share of a tolerance that goes into drawing a medium's exponentials as lines; compression has the rest, so that
// both together stay inside it.
double linearisation_of(double tolerance);

}  // namespace shadowbench::techniques
