// The order in which the segments of a ray are inserted (Salvi et al. 2010, section 4.1: it matters once nodes are
// dropped).
#pragma once

#include <bit>
#include <cstdint>

#include "base/random.h"

namespace shadowbench::techniques {

// A permutation of [0, count) that is computed entry by entry and takes no memory: a Feistel network of four rounds
// over the least even number of bits that holds every entry, applied again while the result lies outside (Black and
// Rogaway, Ciphers with Arbitrary Finite Domains, 2002, section 4).
class Shuffle {
public:
    Shuffle(std::uint64_t key, std::uint32_t count)
        : key_(key), count_(count), half_((std::bit_width(count > 1 ? count - 1 : 1u) + 1) / 2) {}

    std::uint32_t operator()(std::uint32_t entry) const {
        std::uint64_t at = entry;
        do {
            at = rounds(at);
        } while (at >= count_);
        return static_cast<std::uint32_t>(at);
    }

private:
    std::uint64_t rounds(std::uint64_t at) const {
        const std::uint64_t mask = (std::uint64_t{1} << half_) - 1;
        std::uint64_t left = at >> half_, right = at & mask;
        for (std::uint64_t round = 0; round < 8; ++round) {
            const std::uint64_t next = left ^ (base::hash(key_, round, right) & mask);
            left = right;
            right = next;
        }
        return left << half_ | right;
    }

    std::uint64_t key_;
    std::uint32_t count_;
    int half_;  // bits
};

}  // namespace shadowbench::techniques
