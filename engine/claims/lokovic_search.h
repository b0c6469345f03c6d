// Section 3.4 of Lokovic and Veach, Deep Shadow Maps, 2000: the pointer that each pixel stores to the segment that was
// used last.
#pragma once

#include <cstdint>

namespace shadowbench::claims::lokovic {

// The first of n sorted depths that is not less than z, or n if there is none, found linearly forward or backward from
// `last`, which is at most n and becomes the answer.
inline std::uint32_t search_from(std::uint32_t& last, const float* depths, std::uint32_t n, float z) {
    while (last < n && depths[last] < z) ++last;
    while (last > 0 && !(depths[last - 1] < z)) --last;
    return last;
}

}  // namespace shadowbench::claims::lokovic
