// The streaming compression of stream.h for several texels side by side, one in each SIMD lane.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace shadowbench::techniques {

inline constexpr std::size_t stream_lanes = 16;

// The next segments of each lane, row after row. One that transmits everything changes nothing.
struct SegmentRows {
    static constexpr std::size_t most = 16;
    std::size_t count = 0;
    alignas(64) std::array<std::array<float, stream_lanes>, most> front, back, through;

    void set(std::size_t row, std::size_t lane, float its_front, float its_back, float its_through) {
        front[row][lane] = its_front;
        back[row][lane] = its_back;
        through[row][lane] = its_through;
    }
};

// Each lane holds, bit for bit, the curve of a TransmittanceStream<nodes> with linear sampling, for segments before the
// far plane. Of those that touch it the last bits may differ. There are streams of 4, 8 and 16 nodes.
//
// The nodes lie in their order. Places behind the far plane's are infinitely far, with its value. Since
// TransmittanceStream tells nodes of equal areas apart by their slots, each node has the number of the slot that it
// would have there.
template <int nodes>
struct StreamLanes {
    template <class Number>
    using Row = std::array<Number, stream_lanes>;

    float far_plane;
    alignas(64) std::array<Row<float>, nodes> depth, value;
    std::array<Row<std::int32_t>, nodes> slot;
    // Of a lane with all nodes: the free slots that it would take first and second. Before, they are those after
    // `size`.
    Row<std::int32_t> size, first_free, second_free;

    explicit StreamLanes(float its_far_plane) : far_plane(its_far_plane) {
        for (std::size_t l = 0; l < stream_lanes; ++l) clear(l);
    }
    void clear(std::size_t lane) {
        for (int i = 0; i < nodes; ++i) {
            depth[i][lane] = i == 0 ? far_plane : std::numeric_limits<float>::infinity();
            value[i][lane] = 1.0f;
            slot[i][lane] = 0;
        }
        size[lane] = 1;
        first_free[lane] = nodes;
        second_free[lane] = nodes + 1;
    }

    void insert(const SegmentRows& rows);

    // Writes the depths, then the values. Unused nodes are at the far plane with the last value.
    void store(std::size_t lane, float* texel) const {
        for (int i = 0; i < nodes; ++i) {
            texel[i] = std::min(depth[i][lane], far_plane);
            texel[nodes + i] = value[i][lane];
        }
    }
};

}  // namespace shadowbench::techniques
