// Random numbers that depend only on their keys, never on the order of calls or the thread.
#pragma once

#include <cstdint>

namespace shadowbench::base {

// Finaliser of SplitMix64 (Steele, Lea, Flood 2014): a bijection with full avalanche.
constexpr std::uint64_t mix(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

// Hashes a key of up to four words to 64 random bits.
constexpr std::uint64_t hash(std::uint64_t a, std::uint64_t b = 0, std::uint64_t c = 0, std::uint64_t d = 0) {
    return mix(mix(mix(mix(a) ^ b) ^ c) ^ d);
}

// A number uniform in [0, 1) that uses all 53 bits of a double.
constexpr double to_unit(std::uint64_t bits) {
    return static_cast<double>(bits >> 11) * 0x1p-53;
}

// The sequence of random numbers that belongs to a key.
class Random {
public:
    explicit constexpr Random(std::uint64_t key) : state_(key) {}

    constexpr std::uint64_t bits() { return mix(state_++); }
    constexpr double uniform() { return to_unit(bits()); }
    constexpr double uniform(double low, double high) { return low + (high - low) * uniform(); }
    // Uniform in [0, n), n > 0.
    constexpr std::uint64_t below(std::uint64_t n) {
        __extension__ using Wide = unsigned __int128;
        return static_cast<std::uint64_t>((static_cast<Wide>(bits()) * n) >> 64);
    }

private:
    std::uint64_t state_;
};

}  // namespace shadowbench::base
