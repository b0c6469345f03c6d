#include "techniques/fourier/series.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>

#include "base/simd_path.h"

namespace shadowbench::techniques {
namespace {

constexpr double pi = std::numbers::pi;

// 1 / (2 pi k); 0 for k = 0, which has another weight.
const Harmonics& reciprocals() {
    static const Harmonics table = [] {
        Harmonics result{};
        for (int k = 1; k < most_terms; ++k) result[k] = 1.0 / (2.0 * pi * k);
        return result;
    }();
    return table;
}

// 2 / (2 pi k); 0 for k = 0.
const std::array<float, most_terms>& weight_scales() {
    static const std::array<float, most_terms> table = [] {
        std::array<float, most_terms> result{};
        for (int k = 1; k < most_terms; ++k) result[k] = static_cast<float>(1.0 / (pi * k));
        return result;
    }();
    return table;
}

// sin(2 pi t) for t in [-1/4, 1/4]: the odd polynomial of degree 9 with the least maximum error (3.3e-9, found by
// Remez's exchange); within 1.9e-7 in float.
inline float sine_of_turn(float t) {
    const float u = t * t;
    return t * (6.28318501f + u * (-41.3416557f + u * (81.6010056f + u * (-76.5497818f + u * 39.536705f))));
}

}  // namespace

void harmonics(double x, int terms, Harmonics& cosines, Harmonics& sines) {
    cosines[0] = 1.0;
    sines[0] = 0.0;
    cosines[1] = std::cos(x);
    sines[1] = std::sin(x);
    double step_cosine = 1.0, step_sine = 0.0;  // of 8 x
    for (int k = 2; k <= lanes; ++k) {          // k x = i x + j x
        const int i = k / 2, j = k - i;
        const double cosine = cosines[i] * cosines[j] - sines[i] * sines[j];
        const double sine = sines[i] * cosines[j] + cosines[i] * sines[j];
        if (k < lanes) {
            cosines[k] = cosine;
            sines[k] = sine;
        } else {
            step_cosine = cosine;
            step_sine = sine;
        }
    }
    for (int first = lanes; first < terms; first += lanes)
        for (int l = 0; l < lanes; ++l) {
            const double cosine = cosines[first - lanes + l], sine = sines[first - lanes + l];
            cosines[first + l] = cosine * step_cosine - sine * step_sine;
            sines[first + l] = sine * step_cosine + cosine * step_sine;
        }
}

// Over [front, back] with middle m and width w the means of cos(2 pi k x) and sin(2 pi k x) are the values at m times
// sin(pi k w) / (pi k w). This avoids differences of nearly equal numbers, however thin the segment.
void Series::add(double front, double back, double absorption, int terms) {
    Harmonics cosines, sines;
    harmonics(pi * (front + back), terms, cosines, sines);
    const double width = back - front;
    if (width > 0.0) {
        Harmonics unused, sinc;
        harmonics(pi * width, terms, unused, sinc);
        const double scale = 2.0 / width;  // sin(pi k w) / (pi k w) = sin(pi k w) * scale / (2 pi k)
        const Harmonics& reciprocal = reciprocals();
        for (int k = 0; k < terms; ++k) {
            const double mean = k > 0 ? sinc[k] * scale * reciprocal[k] : 1.0;
            cosines[k] *= mean;
            sines[k] *= mean;
        }
    }
    for (int k = 0; k < terms; ++k) {
        a[k] += 2.0 * absorption * cosines[k];
        b[k] += 2.0 * absorption * sines[k];
    }
}

void Series::store(int terms, float* texel) const {
    for (int k = 0; k < terms; ++k) {
        texel[k] = static_cast<float>(a[k]);
        texel[terms + k] = static_cast<float>(b[k]);
    }
    std::fill(texel + 2 * terms, texel + padded(terms), 0.0f);
}

namespace {

// Calls no library function. Angles are counted in turns of 2^32 steps, so that k d loses its whole turns without
// error: with r the rest, in [-1/2, 1/2), sin(2 pi k d) = 2 sin(pi r) cos(pi r) and 1 - cos(2 pi k d) = 2 sin(pi r)^2,
// which keeps its digits where it is small.
SHADOWBENCH_SIMD_LOOP inline void weights_at(double d, int terms, const float* scale, float* __restrict of) {
    const auto step = static_cast<std::uint32_t>(static_cast<std::uint64_t>(d * 0x1p32 + 0.5));
    for (int k = 0; k < terms; ++k) {
        const float r = static_cast<float>(static_cast<std::int32_t>(step * static_cast<std::uint32_t>(k))) * 0x1p-32f;
        const float sine = sine_of_turn(0.5f * r), cosine = sine_of_turn(0.25f - 0.5f * std::abs(r));
        of[k] = scale[k] * (sine * cosine);
        of[terms + k] = scale[k] * (sine * sine);
    }
}

// The integral: the sum of the products, as `lanes` partial sums. Of these it adds the first half to the second; the
// rest is for whole().
SHADOWBENCH_SIMD_LOOP inline void integrate(const float* texel, const float* weights, int floats, float* halves) {
    // A vector of the compiler's: one AVX register, or two of SSE.
    using Lanes = float __attribute__((vector_size(lanes * sizeof(float))));
    Lanes sums{}, coefficients, factors;
    for (int i = 0; i < floats; i += lanes) {
        std::memcpy(&coefficients, texel + i, sizeof coefficients);
        std::memcpy(&factors, weights + i, sizeof factors);
        sums += coefficients * factors;
    }
    float all[lanes];
    std::memcpy(all, &sums, sizeof sums);
    for (int l = 0; l < lanes / 2; ++l) halves[l] = all[l] + all[l + lanes / 2];
}
SHADOWBENCH_SIMD_LOOP inline float whole(const float* halves) {
    return (halves[0] + halves[2]) + (halves[1] + halves[3]);
}

// exp(x), as a power of 2 times the polynomial of Cephes' expf (S. Moshier), for a loop that becomes vector
// instructions.
SHADOWBENCH_SIMD_LOOP inline float exponential(float x) {
    x = std::min(std::max(x, -87.0f), 80.0f);
    const float power = (x * 1.44269504f + 0x1.8p23f) - 0x1.8p23f;  // to the nearest whole number
    const float r = (x - power * 0.693359375f) + power * 2.12194440e-4f;
    float p = 1.9875691500e-4f;
    p = p * r + 1.3981999507e-3f;
    p = p * r + 8.3334519073e-3f;
    p = p * r + 4.1665795894e-2f;
    p = p * r + 1.6666665459e-1f;
    p = p * r + 5.0000001201e-1f;
    const float of_rest = p * (r * r) + r + 1.0f;
    return of_rest * std::bit_cast<float>((static_cast<std::int32_t>(power) + 127) << 23);
}

}  // namespace

void make_weights(double d, int terms, Weights& weights) {
    float* of = weights.of.data();
    base::on_simd_path([=, scale = weight_scales().data()]()
                           SHADOWBENCH_SIMD_LOOP { weights_at(d, terms, scale, of); });
    of[0] = static_cast<float>(0.5 * d);
    std::fill(of + 2 * terms, of + padded(terms), 0.0f);
}

float transmittance(const float* texel, const Weights& weights, int floats, float highest) {
    std::array<float, lanes / 2> halves;
    integrate(texel, weights.of.data(), floats, halves.data());
    return std::min(exponential(-whole(halves.data())), highest);
}

void transmittances(Reads& reads, const std::array<Weights, block_queries>& weights, int floats, float highest) {
    base::on_simd_path([&reads, &weights, floats, highest]() SHADOWBENCH_SIMD_LOOP {
        constexpr std::size_t half = lanes / 2;
        std::array<float, half * Reads::most> halves;
        for (std::size_t r = 0; r < reads.count; ++r)
            integrate(reads.texel[r], weights[reads.query[r]].of.data(), floats, halves.data() + half * r);
        float* __restrict values = reads.value.data();
        for (std::size_t r = 0; r < reads.count; ++r)
            values[r] = std::min(exponential(-whole(halves.data() + half * r)), highest);
    });
}

}  // namespace shadowbench::techniques
