// What a block of lookups reads: cells of equal size, their weights, and the answers that they add up to.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "techniques/store/cover.h"

namespace shadowbench::techniques {

// Texels that are evaluated together, in one of two arrangements:
//  - in slots: read s * block_queries + k is the s-th of query k, for every query of a full block. A query that has
//    fewer texels, or lies outside the map, has reads without weight in the other slots;
//  - in any order, of queries that may have thousands of texels: they go on in the next lot.
// Both have the texels of a query in the same order, so their sums have the same bits.
struct Reads {
    static constexpr std::size_t most_slots = cell_slots, most = most_slots * block_queries;
    // Of a shorter block the empty places in slots would take longer than they save.
    static constexpr std::size_t fewest_in_slots = 8;

    std::size_t count = 0;
    std::size_t slots = 0;  // 0: in any order
    std::array<const float*, most> texel;
    std::array<std::uint8_t, most> query;  // its number in the block
    alignas(64) std::array<double, most> weight;
    alignas(64) std::array<float, most> value;  // the visibility that the texel gives at the query's depth

    // Begins an arrangement.
    void begin(std::size_t number_of_slots);
    // In any order, while there is room.
    void add(const float* at, std::size_t number, double its_weight) {
        texel[count] = at;
        weight[count] = its_weight;
        query[count++] = static_cast<std::uint8_t>(number);
    }
    bool full() const { return count == most; }
};

// The weights of four_cells(); 0 for a cell that repeats another.
void set_weights(const Cover& cover, double* weights);

// answers[k]: the weighted mean of query k, at most `highest`; 1 outside the map. For reads in slots; a single one
// needs no weights.
void average(const Reads& reads, const std::array<bool, block_queries>& inside, float highest,
             std::span<float> answers);

// Loads the lines of a texel of this many floats into the cache, at most four: more would not arrive in time.
inline void prefetch_texel(const float* texel, int floats) {
    constexpr int floats_a_line = 16;
    for (int i = 0; i < floats && i < 4 * floats_a_line; i += floats_a_line) __builtin_prefetch(texel + i);
}

}  // namespace shadowbench::techniques
