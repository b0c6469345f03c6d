#include "curves/depth_sort.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace shadowbench::curves {

namespace {

constexpr std::size_t kFew = 96;     // ranks up to here
constexpr std::size_t kMany = 4096;  // wide digits pay from here
constexpr int kNarrow = 8, kWide = 11;

// Counts for every item how many items precede it. Quadratic, but without branches to mispredict.
void sort_by_rank(std::vector<std::uint64_t>& items, std::vector<std::uint64_t>& scratch) {
    const std::size_t count = items.size();
    std::array<std::uint32_t, kFew> keys, ranks;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t key = static_cast<std::uint32_t>(items[i] >> 32);
        std::uint32_t rank = 0;
        for (std::size_t k = 0; k < i; ++k) {
            const std::uint32_t behind = keys[k] > key;
            ranks[k] += behind;
            rank += 1u - behind;
        }
        keys[i] = key;
        ranks[i] = rank;
    }
    scratch.resize(count);
    for (std::size_t i = 0; i < count; ++i) scratch[ranks[i]] = items[i];
    items.swap(scratch);
}

}  // namespace

void sort_by_depth(std::vector<std::uint64_t>& items, std::vector<std::uint64_t>& scratch) {
    const std::size_t count = items.size();
    if (count <= kFew) return sort_by_rank(items, scratch);

    std::uint64_t least = items[0], most = items[0];
    for (const std::uint64_t item : items) {
        least = std::min(least, item);
        most = std::max(most, item);
    }
    // Depths of one pixel lie close together: few of their 32 bits differ once the least depth is subtracted.
    const std::uint32_t base = static_cast<std::uint32_t>(least >> 32);
    const int width = std::bit_width(static_cast<std::uint32_t>(most >> 32) - base);
    if (width == 0) return;
    const int passes = (width + (count < kMany ? kNarrow : kWide) - 1) / (count < kMany ? kNarrow : kWide);
    const int digit = (width + passes - 1) / passes;
    const std::uint32_t mask = (1u << digit) - 1u;

    scratch.resize(count);
    std::array<std::uint32_t, 1u << kWide> start;
    for (int shift = 0; shift < width; shift += digit) {
        const auto bucket = [&](std::uint64_t item) {
            return ((static_cast<std::uint32_t>(item >> 32) - base) >> shift) & mask;
        };
        std::fill_n(start.begin(), mask + 1u, 0u);
        for (const std::uint64_t item : items) ++start[bucket(item)];
        std::uint32_t sum = 0;
        for (std::uint32_t b = 0; b <= mask; ++b) sum += std::exchange(start[b], sum);
        for (const std::uint64_t item : items) scratch[start[bucket(item)]++] = item;
        items.swap(scratch);
    }
}

}  // namespace shadowbench::curves
