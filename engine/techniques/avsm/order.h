// The order in which the segments of a ray are inserted (Salvi et al. 2010, section 4.1: it matters once nodes are
// dropped).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/random.h"
#include "rays/light_rays.h"

namespace shadowbench::techniques {

// A permutation of [0, count) that is computed as it is needed, in memory that does not grow with it: a Feistel network
// of eight rounds over the least even number of bits that holds every entry, applied again while the result lies
// outside (Black and Rogaway, Ciphers with Arbitrary Finite Domains, 2002, section 4). Up to 65,536 entries it looks up
// what each round makes of each half.
class Shuffle {
public:
    static constexpr std::size_t most_entries = 64;  // at once

    void begin(std::uint64_t key, std::uint32_t count) {
        count_ = count;
        half_ = (std::bit_width(count > 1 ? count - 1 : 1u) + 1) / 2;
        mask_ = (1u << half_) - 1;
        for (std::uint64_t r = 0; r < rounds; ++r) keys_[r] = base::mix(base::mix(key) ^ r);
        if (!looks_up()) return;
        for (std::size_t r = 0; r < rounds; ++r)
            for (std::uint32_t half = 0; half <= mask_; ++half)
                table_[r][half] = static_cast<std::uint8_t>(hash(r, half));
    }

    // The entries from `first` on. Many at once: whether a result lies outside cannot be predicted, so a loop for each
    // entry would wait for its rounds.
    void entries(std::uint32_t first, std::span<std::uint32_t> out) const {
        std::array<std::uint32_t, most_entries> outside;
        for (std::uint32_t i = 0; i < out.size(); ++i) {
            out[i] = first + i;
            outside[i] = i;
        }
        for (std::size_t left = out.size(), next = 0; left > 0; left = next, next = 0)
            for (std::size_t i = 0; i < left; ++i) {
                std::uint32_t& at = out[outside[i]];
                at = looks_up() ? all_rounds(at, [&](std::size_t r, std::uint32_t half) { return table_[r][half]; })
                                : all_rounds(at, [&](std::size_t r, std::uint32_t half) { return hash(r, half); });
                outside[next] = outside[i];
                next += at >= count_;
            }
    }

private:
    static constexpr std::size_t rounds = 8;
    static constexpr int most_bits = 8;  // of a half in a table

    bool looks_up() const { return half_ <= most_bits; }
    // base::hash() of the key, the round and the half.
    std::uint32_t hash(std::size_t round, std::uint32_t half) const {
        return static_cast<std::uint32_t>(base::mix(base::mix(keys_[round] ^ half))) & mask_;
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

    std::uint32_t count_ = 0, mask_ = 0;  // the mask: of a half
    int half_ = 0;                        // bits
    std::array<std::uint64_t, rounds> keys_;
    std::array<std::array<std::uint8_t, 1 << most_bits>, rounds> table_;
};

enum class Order { sorted, captured, shuffled };

// Names the segments of a ray, one after the other.
class SegmentOrder {
public:
    void begin(const rays::LightRays& rays, std::size_t ray, Order order, std::uint64_t key) {
        order_ = order;
        submission_ = rays.submission.data();
        first_ = at_ = rays.begin[ray];
        end_ = rays.begin[ray + 1];
        if (order == Order::shuffled) shuffle_.begin(key, end_ - first_);
    }
    std::uint32_t left() const { return end_ - at_; }

    std::uint32_t next() {
        const std::uint32_t at = at_++;
        if (order_ == Order::sorted) return at;
        if (order_ == Order::captured) return submission_[at];
        const std::uint32_t k = (at - first_) % Shuffle::most_entries;
        if (k == 0)
            shuffle_.entries(at - first_,
                             std::span(shuffled_).first(std::min<std::size_t>(Shuffle::most_entries, end_ - at)));
        return first_ + shuffled_[k];
    }

private:
    Order order_ = Order::sorted;
    const std::uint32_t* submission_ = nullptr;
    std::uint32_t first_ = 0, at_ = 0, end_ = 0;
    Shuffle shuffle_;
    std::array<std::uint32_t, Shuffle::most_entries> shuffled_;  // the next ones
};

}  // namespace shadowbench::techniques
