// The values of many functions of a deep map at once: their segments are found one after another, then joined side by
// side.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "techniques/deep/deep_level.h"
#include "techniques/store/cover.h"

namespace shadowbench::techniques {

// Of the functions of pixels in slots (see CellSlots), each at the depth of its query.
struct Segments {
    struct Range {
        std::uint32_t begin, end;  // DeepLevel::offsets of the pixel and the next one
    };
    struct Two {
        float left, right;
    };
    static constexpr std::size_t most = cell_slots * block_queries;

    std::size_t slots = 0;  // how many are in use: 1, 2 or 4; given, as are:
    CellSlots pixel;
    alignas(64) std::array<float, block_queries> z;
    // Found:
    alignas(64) std::array<Range, most> range;           // of the floats of the function
    alignas(64) std::array<std::uint32_t, most> left{};  // the last node before z, or else the first
    // Of that node and the next float, which is no node behind the last one. Anything if the function has no nodes.
    alignas(64) std::array<Two, most> depths{}, values{};
};

// Finds the segments in a map of one channel. All cache lines of a large map are prefetched before the first is
// searched, so that their misses overlap.
void find_segments(const DeepLevel& map, Segments& segments);

// means[k]: the mean over the slots of query k with these weights; at most 1.
void mean_of(const Segments& segments, const double* weights, float* means);

}  // namespace shadowbench::techniques
