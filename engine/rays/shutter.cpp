#include "rays/shutter.h"

#include <utility>

#include "base/random.h"

namespace shadowbench::rays {

std::uint32_t scatter(std::uint32_t index, std::uint32_t count, std::uint64_t key) {
    std::uint64_t node = base::mix(key);  // random bits of the remaining part of [0, count)
    const std::uint64_t rotation = ((node >> 32) * count) >> 32;
    std::uint32_t first = 0;
    for (std::uint32_t size = count; size > 1; index /= 2) {
        const std::uint32_t odd = index % 2, odds = size / 2, evens = size - odds;
        const std::uint32_t odds_first = node & 1;
        first += odd == odds_first ? 0 : odd ? evens : odds;
        size = odd ? odds : evens;
        node = (node + odd) * 0xd1342543de82ef95ull;  // one random bit suffices, so the weaker generator does
        node ^= node >> 32;
    }
    const std::uint64_t place = first + rotation;
    return static_cast<std::uint32_t>(place < count ? place : place - count);
}

std::uint32_t shutter_part(int samples_x, int samples_y, int column, int row, std::uint64_t key) {
    const auto key_of = [&](std::uint64_t what) { return base::mix(key ^ what); };
    std::uint32_t s = static_cast<std::uint32_t>(samples_x), n = static_cast<std::uint32_t>(samples_y);
    std::uint32_t i = static_cast<std::uint32_t>(column), j = static_cast<std::uint32_t>(row);
    if (s > n) {
        std::swap(s, n);
        std::swap(i, j);
    }
    const std::uint64_t k = scatter(i, s, key_of(1)), r = scatter(j, n, key_of(2));
    const std::uint32_t stretch = static_cast<std::uint32_t>((k * n / s + r) % n);
    const std::uint64_t turn = ((key_of(3 + static_cast<std::uint64_t>(stretch)) >> 32) * s) >> 32;
    return static_cast<std::uint32_t>(stretch * s + (k + turn) % s);
}

}  // namespace shadowbench::rays
