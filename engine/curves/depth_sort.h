// Sorts by depth. An item is 64 bits: the upper half is a key in the order of depth, the lower half any number.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace shadowbench::curves {

// A key in the order of z; -0 and 0 are the same depth.
inline std::uint32_t depth_key(float z) {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(z + 0.0f);
    return bits ^ (static_cast<std::uint32_t>(static_cast<std::int32_t>(bits) >> 31) | 0x80000000u);
}

inline float key_depth(std::uint32_t key) {
    const std::uint32_t flipped = static_cast<std::uint32_t>(static_cast<std::int32_t>(~key) >> 31);
    return std::bit_cast<float>(key ^ (flipped | 0x80000000u));
}

inline std::uint64_t depth_item(float z, std::uint32_t number) {
    return static_cast<std::uint64_t>(depth_key(z)) << 32 | number;
}

// Sorts by the upper halves, stable. `scratch` grows to the size of `items`. O(n) for large n: a radix sort over only
// the bits in which the keys differ.
void sort_by_depth(std::vector<std::uint64_t>& items, std::vector<std::uint64_t>& scratch);

}  // namespace shadowbench::curves
