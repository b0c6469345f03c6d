// Finds the segment of a stored function that holds a depth. All searches give the same answer.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <experimental/simd>

#include "techniques/deep/deep_level.h"

namespace shadowbench::techniques {

enum class Search {
    binary,  // bisects down to a few depths, which are compared at once
    linear,  // from the front
    cached,  // from the segment used last in the same pixel (Lokovic and Veach 2000, section 3.4), else binary
};

// Each returns the first of n sorted depths that is not less than z, or n if there is none; n > 0. A NaN returns 0.
// `depths` may be read up to DeepLevel::padding floats further.

struct BinarySearch {
    static constexpr std::uint32_t lanes = DeepLevel::padding;  // depths that are compared at once

    [[gnu::always_inline]] std::uint32_t operator()(const float* depths, std::uint32_t n, float z) const {
        using Lanes = std::experimental::fixed_size_simd<float, static_cast<int>(lanes)>;
        const float* first = depths;
        while (n > lanes) {  // most functions are shorter
            const std::uint32_t half = n / 2;
            first += first[half - 1] < z ? half : 0;
            n -= half;
        }
        const Lanes number([](auto lane) { return static_cast<float>(lane); });
        const auto before = (Lanes(first, std::experimental::element_aligned) < z) &&
                            (number < static_cast<float>(static_cast<int>(n)));
        // They are the first ones, so the position of the last bit set gives their number, without an instruction that
        // counts bits.
        const std::uint32_t count = any_of(before) ? static_cast<std::uint32_t>(find_last_set(before)) + 1 : 0;
        return static_cast<std::uint32_t>(first - depths) + count;
    }
};

struct LinearSearch {
    std::uint32_t operator()(const float* depths, std::uint32_t n, float z) const {
        std::uint32_t i = 0;
        while (i < n && depths[i] < z) ++i;
        return i;
    }
};

// Remembers segments for one batch of lookups, so that threads share nothing. The paper's pointer for each pixel would
// cost as many bytes as the offsets; this is a small table of the pixels used last.
class CachedSearch {
public:
    // A table that suits a batch of this many lookups.
    explicit CachedSearch(std::size_t lookups) : mask_(std::bit_ceil(lookups < most ? lookups + 1 : most) - 1) {
        for (std::size_t i = 0; i <= mask_; ++i) entries_[i].depths = nullptr;
    }
    std::uint32_t operator()(const float* depths, std::uint32_t n, float z) {
        Entry& entry = entries_[reinterpret_cast<std::uintptr_t>(depths) * 0x9e3779b97f4a7c15u >> 32 & mask_];
        std::uint32_t i = std::min(entry.next, n);  // another function may have taken this one's place in memory
        if (entry.depths != depths) {
            i = BinarySearch()(depths, n, z);
        } else {
            while (i < n && depths[i] < z) ++i;
            while (i > 0 && !(depths[i - 1] < z)) --i;
        }
        entry = {depths, i};
        return i;
    }

private:
    static constexpr std::size_t most = 1024;
    struct Entry {
        const float* depths;  // identify the pixel
        std::uint32_t next;
    };
    std::size_t mask_;
    std::array<Entry, most> entries_;
};

}  // namespace shadowbench::techniques
