// A random subset of the cells that a region covers, each cell at most once: the other way to choose the depths that
// percentage closer filtering compares. Lokovic, Veach 2000, section 6.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "techniques/depth/pcf_samples.h"

namespace shadowbench::techniques {

// Along one side of a region: the middles of the cells that lie inside it, one cell apart; or the position of the
// lookup itself, if the region is too narrow to hold the middle of any cell.
struct Middles {
    double first;
    std::uint64_t count;
};

// The middles in [from, to), which holds `at`. Cells further than 2^24 from the map's corner, where there is no map,
// are left out.
inline Middles middles(float from, float to, float at) {
    constexpr double far = 16777216.0;
    const double begin = std::ceil(std::max<double>(from, -far) - 0.5);
    const double end = std::ceil(std::min<double>(to, far) - 0.5);
    if (!(begin < end)) return {at, 1};
    return {begin + 0.5, static_cast<std::uint64_t>(end - begin)};
}

// Whole numbers, each kept once.
class NumbersSeen {
public:
    static constexpr int most = 4096;

    // For at most `numbers` of them, itself at most `most`.
    explicit NumbersSeen(int numbers) {
        while (1 << bits_ < 2 * numbers) ++bits_;
        std::fill(slots_, slots_ + (std::size_t{1} << bits_), none);
    }
    // Returns false if the number was there.
    bool add(std::uint64_t number) {
        const std::size_t mask = (std::size_t{1} << bits_) - 1;
        std::size_t slot = number * 0x9e3779b97f4a7c15ull >> (64 - bits_);
        while (slots_[slot] != none) {
            if (slots_[slot] == number) return false;
            slot = (slot + 1) & mask;
        }
        slots_[slot] = number;
        return true;
    }

private:
    static constexpr std::uint64_t none = ~std::uint64_t{0};
    int bits_ = 1;
    std::uint64_t slots_[2 * most];
};

// Calls visit(number, bits) for `wanted` different numbers below `count`, or for all if there are fewer. All subsets of
// that size are equally likely: Floyd's method (Bentley, Floyd, Programming Pearls: A Sample of Brilliance, 1987). The
// low 21 of the random bits are independent of the numbers as long as count is below 2^43.
template <class Visit>
int for_each_of_subset(std::uint64_t count, int wanted, std::uint64_t key, const Visit& visit) {
    __extension__ using Wide = unsigned __int128;
    const int chosen = static_cast<int>(std::min<std::uint64_t>(count, static_cast<std::uint64_t>(wanted)));
    NumbersSeen seen(chosen);
    for (std::uint64_t last = count - static_cast<std::uint64_t>(chosen); last < count; ++last) {
        const std::uint64_t bits = sample_bits(key);
        auto number = static_cast<std::uint64_t>(static_cast<Wide>(bits) * (last + 1) >> 64);
        if (!seen.add(number)) {
            number = last;
            seen.add(number);
        }
        visit(number, bits);
    }
    return chosen;
}

// Calls visit(x, y, u) as for_each_sample does, for `wanted` of the cells whose middles lie in the region, or for all
// if there are fewer; x and y are the middle of the cell. Returns the number of calls. `wanted` is at most
// NumbersSeen::most.
template <class Visit>
int for_each_in_subset(const Extent& region, float x, float y, int wanted, std::uint64_t key, const Visit& visit) {
    const Middles across = middles(region.x0, region.x1, x), down = middles(region.y0, region.y1, y);
    const double per_row = 1.0 / static_cast<double>(across.count);
    return for_each_of_subset(across.count * down.count, wanted, key, [&](std::uint64_t cell, std::uint64_t bits) {
        // Exact, since a region has at most 2^50 cells, and faster than a division of whole numbers.
        const double row = std::floor((static_cast<double>(cell) + 0.5) * per_row);
        const double column = static_cast<double>(cell) - row * static_cast<double>(across.count);
        visit(static_cast<float>(across.first + column), static_cast<float>(down.first + row),
              static_cast<float>(static_cast<std::int32_t>(bits & 0x1fffff)) * 0x1p-21f);
    });
}

}  // namespace shadowbench::techniques
