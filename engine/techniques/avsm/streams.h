// The streaming compression of texels (Salvi et al. 2010, section 3.2): inserts a segment, then drops the nodes that
// change the area under the curve least until no more than the texel's number are left. Many texels at once.
#pragma once

#include <array>
#include <cstddef>

#include "techniques/avsm/sampling.h"

namespace shadowbench::techniques {

inline constexpr int most_nodes = 64;
inline constexpr std::size_t lanes = 16;

// One texel a lane: the depths of its nodes, which do not decrease, and their values, which do not increase and stay in
// [0, 1]. The last node is always at the far plane, and so are those that are not in use, with the same value. The
// value before the first node is that node's.
struct Streams {
    alignas(64) std::array<std::array<float, lanes>, most_nodes> depth, value;

    void clear(std::size_t lane, int nodes, float far_plane) {
        for (int i = 0; i < nodes; ++i) {
            depth[i][lane] = far_plane;
            value[i][lane] = 1.0f;
        }
    }
    // Appends a node behind all others; the far plane takes its value. For curves that are given node by node.
    void append(std::size_t lane, int nodes, float its_depth, float its_value);
    // Writes the depths, then the values.
    void store(std::size_t lane, int nodes, float* texel) const {
        for (int i = 0; i < nodes; ++i) {
            texel[i] = depth[i][lane];
            texel[nodes + i] = value[i][lane];
        }
    }
};

// The next segments of each lane: `count` rows. A segment has constant extinction from front to back (front == back: a
// surface) and transmits `through`. All of it must lie before the far plane. One that transmits everything changes
// nothing.
struct SegmentRows {
    static constexpr std::size_t most = 16;
    std::size_t count = 0;
    alignas(64) std::array<std::array<float, lanes>, most> front, back, through;

    void set(std::size_t row, std::size_t lane, float its_front, float its_back, float its_through) {
        front[row][lane] = its_front;
        back[row][lane] = its_back;
        through[row][lane] = its_through;
    }
};

// Inserts the segments, row after row, into streams of so many nodes, 2 to most_nodes. They may come in any order of
// depth. Each rounds the values behind it by up to 2^-24 of themselves, as the published floats do.
//
// While no node has been dropped, the order changes the curve only by rounding, if everything between two nodes is what
// the sampling assumes: always for surfaces, and for overlapping media with exponential sampling. With linear sampling,
// a node that a later segment puts inside a medium lies on its chord.
using Insert = void (*)(Streams& streams, const SegmentRows& segments, int nodes, Sampling sampling);

// The fastest one for this number of nodes; all give the same values.
Insert inserter(int nodes);

}  // namespace shadowbench::techniques
