// One resolution of a deep shadow map in memory, as it is built, looked up, averaged into the next level, and written
// to files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace shadowbench::techniques {

// One function for each pixel, all in one array of floats: pixel p has floats [offsets[p], offsets[p + 1]). A function
// of n nodes is n depths, then n values; for a coloured pixel n depths, then n values of each of the three channels.
// Pixels are row after row. `padding` unused floats follow the last one.
struct DeepLevel {
    static constexpr std::uint32_t padding = 8;  // floats that a lookup may read behind the last node

    int width = 0, height = 0;
    int channels = 1;                    // 1, or 3: then each pixel may hold one channel or three
    std::vector<std::uint32_t> offsets;  // width * height + 1
    std::vector<float> floats;
    std::vector<std::uint64_t> coloured;  // channels == 3: bit p % 64 of word p / 64 says whether pixel p holds three

    std::size_t pixel(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
    bool has_colour(std::size_t p) const { return !coloured.empty() && (coloured[p / 64] >> (p % 64) & 1) != 0; }
    // The number of nodes of pixel p.
    std::uint32_t nodes(std::size_t p) const { return (offsets[p + 1] - offsets[p]) / (has_colour(p) ? 4 : 2); }
    std::size_t bytes() const {
        return offsets.capacity() * sizeof(std::uint32_t) + floats.capacity() * sizeof(float) +
               coloured.capacity() * sizeof(std::uint64_t);
    }
};

}  // namespace shadowbench::techniques
