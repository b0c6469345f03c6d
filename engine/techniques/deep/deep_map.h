// The compressed pixels of a deep shadow map, their building and their lookup. Lokovic and Veach 2000, section 3.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "techniques/cells.h"

namespace shadowbench::techniques {

// A compressed visibility function a pixel, all in one array: the nodes of pixel p are the floats
// [2 offsets[p], 2 offsets[p + 1]), first their depths, then their values, so that a search reads depths alone.
// `padding` unused floats follow the last one.
struct DeepMap {
    static constexpr std::uint32_t padding = 8;  // floats that a lookup may read behind the last node

    float tolerance = 0.0f;
    bool tent = false;  // lookup kernel: a tent twice as wide as the footprint, else a box
    CellGrid grid;
    std::vector<std::uint32_t> offsets;
    std::vector<float> nodes;
    std::size_t peak_bytes = 0;

    void begin(const rays::MapLayout& map_layout);
    void add(const rays::LightRays& tile);
    void finish();

    void lookup(std::span<const Query> queries, std::span<float> visibility) const;
    void touched(const Query& q, std::vector<const void*>& lines) const;
    std::size_t bytes() const { return offsets.capacity() * sizeof(std::uint32_t) + nodes.capacity() * sizeof(float); }
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
