// The truncated Fourier series of the absorption along a ray, and its integral (Jansen and Bavoil 2010, section 3).
//
// Depth is normalised to d in [0, 1]; the absorption is a density w(d), a surface of it a delta:
//   a_k = 2 integral w(x) cos(2 pi k x) dx,   b_k = 2 integral w(x) sin(2 pi k x) dx,   k = 0 .. terms - 1
//   integral of the series from 0 to d
//       = a_0 d / 2 + sum_{k >= 1} a_k sin(2 pi k d) / (2 pi k) + b_k (1 - cos(2 pi k d)) / (2 pi k)
// A term is the pair a_k, b_k.
#pragma once

#include <array>

#include "techniques/store/reads.h"

namespace shadowbench::techniques {

constexpr int most_terms = 64;
constexpr int lanes = 8;  // numbers that a loop handles at once; rows are padded to a multiple of it with zeros

using Harmonics = std::array<double, most_terms>;

// The number of floats of a texel with this many terms: all a_k, all b_k, zeros.
constexpr int padded(int terms) {
    return (2 * terms + lanes - 1) / lanes * lanes;
}

// cosines[k] = cos(k x), sines[k] = sin(k x) for k below `terms` (and up to the next multiple of `lanes`). Makes one
// call of the library; the others are rotations, at most terms / 8 + 3 in sequence, so that errors stay near 1e-15.
void harmonics(double x, int terms, Harmonics& cosines, Harmonics& sines);

// The sums of a ray under construction.
struct Series {
    Harmonics a, b;

    void clear() {
        a.fill(0.0);
        b.fill(0.0);
    }
    // Adds absorption spread evenly over [front, back]; all of it at one depth if they are equal.
    void add(double front, double back, double absorption, int terms);
    // Writes padded(terms) floats.
    void store(int terms, float* texel) const;
};

// The factors of a texel's floats that give the integral up to one depth.
struct Weights {
    alignas(64) std::array<float, 2 * most_terms> of;
};
void make_weights(double d, int terms, Weights& weights);

// exp(-(the integral of a texel of this many floats)), at most `highest`: the transmittance. Within two units in the
// last place for integrals in [-80, 87]; others count as the nearest of these.
float transmittance(const float* texel, const Weights& weights, int floats, float highest);
// The same for all reads, with the same bits; weights[reads.query[r]] are those of read r.
void transmittances(Reads& reads, const std::array<Weights, block_queries>& weights, int floats, float highest);

}  // namespace shadowbench::techniques
