// Visibility functions that are as hard on compression and sums as possible.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/random.h"
#include "curves/curve.h"

namespace shadowbench::curves::cases {

// The kinds of stretches that a function consists of; see append().
enum class Stretch { ulp_steps, plateau, sawtooth, corners, cliff, towards_0, last_digits, denormal, far, anything };
inline constexpr int kStretches = 10;

// One stretch: its kind, its number of moves, and the seed of its random choices.
struct Piece {
    int stretch, length;
    std::uint64_t seed;
};

namespace adversarial {

constexpr float kMost = 1e30f;  // depth
constexpr float kTiny = std::numeric_limits<float>::denorm_min();

struct Builder {
    Curve& curve;
    float z, value;
    double tolerance;

    // Never moves back or up.
    void move(double to_z, double to_value) {
        z = std::min(std::max(z, static_cast<float>(std::min<double>(to_z, kMost))), kMost);
        value = std::clamp(static_cast<float>(to_value), 0.0f, value);
        curve.push_back({z, value});
    }
    float next_depth() const { return std::nextafter(z, kMost); }
    float next_value() const { return std::nextafter(value, 0.0f); }
};

// A drop that a tolerance just allows or just forbids.
inline double edge_drop(double tolerance, base::Random& random) {
    const double factors[] = {0.5, 1.0, 2.0, 2.0000001, 1.9999999, 4.0, 0.999, 1.001};
    return tolerance * factors[random.below(8)];
}

inline void append(Builder& b, Stretch stretch, int length, std::uint64_t seed) {
    base::Random random(seed);
    const double from_z = b.z, from_value = b.value, gap = std::max(1e-3, std::abs(from_z)) * random.uniform(1e-6, 1.0);
    for (int i = 0; i < length; ++i) switch (stretch) {
            case Stretch::ulp_steps:  // layers one float apart
                b.move(b.next_depth(), b.value);
                b.move(b.z, b.value - edge_drop(b.tolerance, random));
                break;
            case Stretch::plateau:  // long and flat, then a fall that the flat part has ruled out
                b.move(b.z + gap * std::exp2(i % 8), b.value);
                if (i + 1 == length) b.move(b.next_depth(), b.value - edge_drop(b.tolerance, random));
                break;
            case Stretch::sawtooth:  // stairs whose teeth fill the tolerance on both sides of a line
                b.move(b.z + gap, b.value);
                b.move(b.z, b.value - 2.0 * b.tolerance * (1.0 + random.uniform(-1e-7, 1e-7)));
                break;
            case Stretch::corners: {  // a line, left by exactly the tolerance, alternately above and below
                const double z = from_z + gap * (i + 1), side = i % 2 ? b.tolerance : -b.tolerance;
                b.move(z, from_value - 2.0 * b.tolerance * (i + 1) + side);
                break;
            }
            case Stretch::cliff:  // slopes that a float cannot hold
                b.move(random.below(2) ? b.next_depth() : b.z + gap * 1e-6, b.value * random.uniform(0.3, 1.0));
                break;
            case Stretch::towards_0:
                b.move(b.z + gap, b.value * 0.01);
                break;
            case Stretch::last_digits:  // the least fall of a float
                b.move(b.z + (random.below(3) ? gap : 0.0), b.next_value());
                break;
            case Stretch::denormal:  // the least move of a float, where floats are finest
                b.move(b.z + kTiny, random.below(2) ? b.value - kTiny : b.value * random.uniform());
                break;
            case Stretch::far:
                b.move(std::max(1.0, std::abs(from_z)) * std::pow(10.0, 6 * (i + 1)),
                       b.value * random.uniform(0.9, 1.0));
                break;
            case Stretch::anything:
                b.move(random.below(3) ? b.z + gap * random.uniform(0.0, 4.0) : b.z,
                       b.value - random.uniform() * random.uniform() * random.uniform());
                break;
        }
}

}  // namespace adversarial

// One stretch after the other, made for this tolerance.
inline Curve from_pieces(float tolerance, int start, const std::vector<Piece>& pieces) {
    const float starts[] = {1.0f, 0.0f, adversarial::kTiny, 1e-3f, 1e6f, -5.0f, 1e-38f};
    const float firsts[] = {1.0f, 1.0f, 1.0f, std::nextafter(1.0f, 0.0f), 0.75f, 2.0f * tolerance, 1e-40f};
    Curve curve;
    adversarial::Builder builder{curve, starts[start % 7], std::min(firsts[start / 7 % 7], 1.0f), tolerance};
    if (!pieces.empty()) builder.move(builder.z, builder.value);
    for (const Piece& piece : pieces)
        adversarial::append(builder, static_cast<Stretch>(piece.stretch), piece.length, piece.seed);
    return curve;
}

// A piece of a light ray.
struct Segment {
    float front, back, through;
};

// Depths around one centre: the centre, floats next to it, near and far depths; each may be repeated.
class DepthPalette {
public:
    explicit DepthPalette(base::Random& random) : random_(random) {
        const float centres[] = {0.0f, adversarial::kTiny, 1e-3f, 1.0f, 3.0f, 1e6f};
        centre_ = centres[random.below(6)];
    }
    float depth() {
        float z = centre_;
        switch (random_.below(6)) {
            case 0:
                return z;
            case 1:
            case 2:
                for (std::uint64_t steps = random_.below(12); steps > 0; --steps) z = std::nextafter(z, 1e30f);
                return z;
            case 3:
                return static_cast<float>(z * random_.uniform(1, 1.001) + random_.uniform(0, 1e-3));
            case 4:
                return static_cast<float>(z + static_cast<double>(random_.below(8)));
            default:
                return static_cast<float>(z + std::pow(10.0, random_.uniform(-6, 9)));
        }
    }

private:
    base::Random& random_;
    float centre_;
};

// Up to `most` segments: only surfaces, or with overlapping media; some are opaque, faint or denormal.
inline std::vector<Segment> adversarial_ray(base::Random& random, DepthPalette& palette, std::uint64_t most,
                                            bool media) {
    const float throughs[] = {0.0f,   adversarial::kTiny, 1e-40f,      1e-38f,      1e-20f, 0.1f, 0.5f,
                              0.999f, 1.0f - 1e-4f,       0.99999994f, 0.99999994f, 1.0f,   0.9f};
    const bool dark = random.below(4) == 0;  // else most rays would end at once
    std::vector<Segment> segments(random.below(most + 1));
    for (Segment& s : segments) {
        const float a = palette.depth(), b = media && random.below(3) > 0 ? palette.depth() : a;
        const float drawn = static_cast<float>(random.uniform(0.5, 1.0));
        s = {std::min(a, b), std::max(a, b),
             random.below(2) ? drawn : throughs[random.below(dark ? 13 : 8) + (dark ? 0 : 5)]};
    }
    return segments;
}

// Random choices only, for tests without a generator of cases.
inline Curve adversarial_function(float tolerance, base::Random& random) {
    std::vector<Piece> pieces(random.below(5));
    for (Piece& piece : pieces)
        piece = {static_cast<int>(random.below(kStretches)), 1 + static_cast<int>(random.below(9)),
                 random.below(1u << 30)};
    return from_pieces(tolerance, static_cast<int>(random.below(49)), pieces);
}

}  // namespace shadowbench::curves::cases
