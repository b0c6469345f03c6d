// The order in which the segments of a ray are inserted (Salvi et al. 2010, section 4.1: it matters once nodes are
// dropped).
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/random.h"

namespace shadowbench::techniques {

// A permutation of [0, count) that is computed as it is needed and takes no memory that grows with it: a Feistel
// network of eight rounds over the least even number of bits that holds every entry, applied again while the result
// lies outside (Black and Rogaway, Ciphers with Arbitrary Finite Domains, 2002, section 4). Of up to 65,536 entries it
// keeps what each round makes of each half.
class Shuffle {
public:
    static constexpr std::size_t most_entries = 64;  // at once

    void begin(std::uint64_t key, std::uint32_t count) {
        count_ = count;
        half_ = (std::bit_width(count > 1 ? count - 1 : 1u) + 1) / 2;
        mask_ = (1u << half_) - 1;
        for (std::uint64_t r = 0; r < rounds; ++r) key_[r] = base::mix(base::mix(key) ^ r);
        if (!kept()) return;
        for (std::size_t r = 0; r < rounds; ++r)
            for (std::uint32_t half = 0; half <= mask_; ++half)
                kept_[r][half] = static_cast<std::uint8_t>(hash(r, half));
    }

    // The entries from `first` on. Many at once: since nobody foresees which results lie outside, a loop for
    // each would wait for its rounds.
    void entries(std::uint32_t first, std::span<std::uint32_t> out) const {
        std::array<std::size_t, most_entries> outside;
        for (std::size_t i = 0; i < out.size(); ++i) {
            out[i] = first + static_cast<std::uint32_t>(i);
            outside[i] = i;
        }
        for (std::size_t left = out.size(), next = 0; left > 0; left = next, next = 0)
            for (std::size_t i = 0; i < left; ++i) {
                std::uint32_t& at = out[outside[i]];
                at = kept() ? all_rounds(at, [this](std::size_t r, std::uint32_t half) { return kept_[r][half]; })
                            : all_rounds(at, [this](std::size_t r, std::uint32_t half) { return hash(r, half); });
                outside[next] = outside[i];
                next += at >= count_;
            }
    }

private:
    static constexpr std::size_t rounds = 8;
    static constexpr int most_kept = 8;  // bits

    bool kept() const { return half_ <= most_kept; }
    // base::hash of the key, the round and the half.
    std::uint32_t hash(std::size_t round, std::uint32_t half) const {
        return static_cast<std::uint32_t>(base::mix(base::mix(key_[round] ^ half))) & mask_;
    }
    template <class Round>
    std::uint32_t all_rounds(std::uint32_t at, const Round& of) const {
        std::uint32_t left = at >> half_, right = at & mask_;
        for (std::size_t r = 0; r < rounds; ++r) {
            const std::uint32_t next = left ^ of(r, right);
            left = right;
            right = next;
        }
        return left << half_ | right;
    }

    std::uint32_t count_ = 0;
    int half_ = 0;            // bits
    std::uint32_t mask_ = 0;  // of a half
    std::array<std::uint64_t, rounds> key_;
    std::array<std::array<std::uint8_t, 1 << most_kept>, rounds> kept_;
};

}  // namespace shadowbench::techniques
