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
    static constexpr std::size_t most_entries = 128;  // at once

    void begin(std::uint64_t key, std::uint32_t count) {
        count_ = count;
        half_ = (std::bit_width(count > 1 ? count - 1 : 1u) + 1) / 2;
        mask_ = (1u << half_) - 1;
        for (std::uint64_t r = 0; r < rounds; ++r) keys_[r] = base::mix(base::mix(key) ^ r);
        if (half_ > most_bits) return;
        for (std::size_t r = 0; r < rounds; ++r) {
            const RoundHash round{keys_[r], mask_};
            for (std::uint32_t half = 0; half <= round.mask; ++half)
                table_[r][half] = static_cast<std::uint8_t>(round(half));
        }
    }

    // The entries from `first` on. Side by side, since each round of an entry waits for the one before.
    void entries(std::uint32_t first, std::span<std::uint32_t> out) const {
        Halves left, right, number;  // of those whose results lie outside
        for (std::uint32_t i = 0; i < out.size(); ++i) {
            left[i] = static_cast<std::uint16_t>((first + i) >> half_);
            right[i] = static_cast<std::uint16_t>((first + i) & mask_);
            number[i] = static_cast<std::uint16_t>(i);
        }
        for (std::size_t outside = out.size(); outside > 0;) {
            if (half_ <= most_bits)
                all_rounds(left, right, outside, [&](std::size_t r) {
                    return [row = table_[r].data()](std::uint32_t half) { return row[half]; };
                });
            else
                all_rounds(left, right, outside, [&](std::size_t r) { return RoundHash{keys_[r], mask_}; });
            std::size_t next = 0;
            for (std::size_t i = 0; i < outside; ++i) {
                const std::uint32_t at = static_cast<std::uint32_t>(left[i]) << half_ | right[i];
                out[number[i]] = at;
                left[next] = left[i];
                right[next] = right[i];
                number[next] = number[i];
                next += at >= count_;
            }
            outside = next;
        }
    }

private:
    static constexpr std::size_t rounds = 8;
    static constexpr int most_bits = 8;  // of a half in a table
    using Halves = std::array<std::uint16_t, most_entries>;

    // base::hash() of the key, the round and the half.
    struct RoundHash {
        std::uint64_t key;
        std::uint32_t mask;
        std::uint32_t operator()(std::uint32_t half) const {
            return static_cast<std::uint32_t>(base::mix(base::mix(key ^ half))) & mask;
        }
    };
    template <class Rounds>
    static void all_rounds(Halves& left, Halves& right, std::size_t count, const Rounds& round_of) {
        for (std::size_t r = 0; r < rounds; r += 2) {
            const auto even = round_of(r), odd = round_of(r + 1);
            for (std::size_t i = 0; i < count; ++i) left[i] = static_cast<std::uint16_t>(left[i] ^ even(right[i]));
            for (std::size_t i = 0; i < count; ++i) right[i] = static_cast<std::uint16_t>(right[i] ^ odd(left[i]));
        }
    }

    std::uint32_t count_ = 0, mask_ = 0;  // the mask: of a half
    int half_ = 0;                        // bits
    std::array<std::uint64_t, rounds> keys_;
    std::array<std::array<std::uint8_t, 1 << most_bits>, rounds> table_;
};

enum class Order { sorted, captured, shuffled };

// Names the segments of a ray, some after others.
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

    // The next ones; so many are left.
    void next(std::span<std::uint32_t> segments) {
        for (std::uint32_t& segment : segments) {
            const std::uint32_t at = at_++;
            segment = order_ == Order::sorted ? at : order_ == Order::captured ? submission_[at] : shuffled(at);
        }
    }

private:
    std::uint32_t shuffled(std::uint32_t at) {
        const std::uint32_t k = (at - first_) % Shuffle::most_entries;
        if (k == 0)
            shuffle_.entries(at - first_,
                             std::span(shuffled_).first(std::min<std::size_t>(Shuffle::most_entries, end_ - at)));
        return first_ + shuffled_[k];
    }

    Order order_ = Order::sorted;
    const std::uint32_t* submission_ = nullptr;
    std::uint32_t first_ = 0, at_ = 0, end_ = 0;
    Shuffle shuffle_;
    std::array<std::uint32_t, Shuffle::most_entries> shuffled_;  // the next ones
};

}  // namespace shadowbench::techniques
