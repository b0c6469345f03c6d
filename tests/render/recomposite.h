// Converts deep samples back to transmittance, as simply as possible.
#pragma once

#include <cmath>
#include <cstddef>

namespace shadowbench::render::testing {

struct Sample {
    float z_front, z_back, alpha;
};

// The product of all samples up to z. A surface counts strictly behind its depth, or also at it if `behind`.
template <class Samples>
double composite(const Samples& samples, float z, bool behind) {
    double product = 1.0;
    for (const Sample& s : samples) {
        const double taken = 1.0 - static_cast<double>(s.alpha);
        if (s.z_front == s.z_back)
            product *= s.z_front < z || (behind && s.z_front == z) ? taken : 1.0;
        else if (z >= s.z_back)
            product *= taken;
        else if (z > s.z_front)
            product *=
                std::pow(taken, (static_cast<double>(z) - s.z_front) / (static_cast<double>(s.z_back) - s.z_front));
    }
    return product;
}

}  // namespace shadowbench::render::testing
