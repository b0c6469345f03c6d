// The maps of figure 7 of Lokovic and Veach, Deep Shadow Maps, 2000: deep maps and depth maps of equal numbers of
// samples, filtered over the width of a pixel.
#pragma once

#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

#include "claims/paper.h"
#include "claims/turns.h"
#include "claims/value.h"

namespace shadowbench::claims::lokovic {

inline constexpr int all_samples[] = {1, 4, 16, 36, 64, 144, 256};  // a pixel, and of a lookup in the depth map
inline constexpr std::size_t few = 1, sixteen = 2, most = std::size(all_samples) - 1;  // places in that list

// Two maps of as many samples. Errors are over all places of the picture.
struct Row {
    int samples;
    Value deep_bytes, depth_bytes, lossless_bytes;  // the last: of a deep map that is not compressed
    Value deep_error, depth_error;
    Value nearest_error;  // of the deep map, where a lookup reads the pixel whose centre is nearest
    double nodes;         // a pixel of the deep map
};

// The same maps at the middles of pixels. There a deep lookup reads one function, and this is the mean of exactly the
// depth samples under the filter.
struct AtMiddles {
    Value depth_error;
    Value ratio;              // the deep map's error over the depth map's: the mean of the ratios of each seed
    Value compressed;         // and over that of the same functions before they are compressed
    double difference = 0.0;  // the largest, in tolerances, from percentage closer filtering of all those samples
};

struct Rows {
    std::vector<Row> rows;
    std::vector<AtMiddles> middles;
    Turns ns;  // a lookup in the maps of each row, at all places of the picture

    static std::size_t deep(std::size_t row) { return 3 * row; }  // the places of its maps among the turns
    static std::size_t depth(std::size_t row) { return 3 * row + 1; }
    static std::size_t nearest(std::size_t row) { return 3 * row + 2; }  // the deep map, by the nearest centre
    // The deep map's time over the depth map's.
    Value slower(std::size_t row) const { return ns.ratio(deep(row), depth(row)); }
    Value nearest_slower(std::size_t row) const { return ns.ratio(nearest(row), depth(row)); }
};
Rows measure_rows(const Context& context);

// The settings of a row, and what a quick run makes smaller.
std::vector<std::string> settings_of_row(int samples);
std::vector<std::string> smaller_row();

}  // namespace shadowbench::claims::lokovic
