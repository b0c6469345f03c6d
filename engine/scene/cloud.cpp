#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/random.h"
#include "scene/fill_grid.h"
#include "scene/procedural.h"

namespace shadowbench::scene {
namespace {

constexpr double first_frequency = 2.0;   // noise cells per half of the box's longest side
constexpr double outward_thinning = 0.7;  // how much lower the density is at the ellipsoid's surface than in its middle
constexpr std::size_t quantile_samples = std::size_t{1} << 20;

// The dot product of a lattice point's gradient (one of the 12 edges of a cube) and the offset from that point.
double gradient(std::uint64_t seed, double x, double y, double z, double dx, double dy, double dz) {
    const auto word = [](double v) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(v)); };
    const std::uint64_t bits = base::hash(seed, word(x), word(y), word(z));
    const double first = bits & 1 ? -1.0 : 1.0;
    const double second = bits & 2 ? -1.0 : 1.0;
    switch ((bits >> 2) % 3) {
        case 0:
            return first * dx + second * dy;
        case 1:
            return first * dy + second * dz;
        default:
            return first * dz + second * dx;
    }
}

// Gradient noise in about [-1, 1] (Perlin, Improving Noise, 2002).
double noise(std::uint64_t seed, const Vec3d& at) {
    const Vec3d cell(std::floor(at.x), std::floor(at.y), std::floor(at.z));
    const Vec3d in = at - cell;
    const auto fade = [](double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); };
    const auto mix = [](double a, double b, double t) { return a + (b - a) * t; };
    const Vec3d weight(fade(in.x), fade(in.y), fade(in.z));
    std::array<double, 4> edges{};
    for (std::size_t i = 0; i < 4; ++i) {
        const double y = static_cast<double>(i & 1), z = static_cast<double>(i >> 1);
        edges[i] = mix(gradient(seed, cell.x, cell.y + y, cell.z + z, in.x, in.y - y, in.z - z),
                       gradient(seed, cell.x + 1, cell.y + y, cell.z + z, in.x - 1, in.y - y, in.z - z), weight.x);
    }
    return mix(mix(edges[0], edges[1], weight.y), mix(edges[2], edges[3], weight.y), weight.z);
}

double fractal(std::uint64_t seed, Vec3d at, int octaves) {
    double sum = 0.0, strength = 1.0;
    for (int octave = 0; octave < octaves; ++octave) {
        sum += strength * noise(base::hash(seed, static_cast<std::uint64_t>(octave)), at);
        at *= 2.0;
        strength *= 0.5;
    }
    return sum;
}

// The value above which `share` of the values inside the ellipsoid lie (`outside` marks the others); takes a fixed
// subset where there are many.
float upper_quantile(const std::vector<float>& values, float outside, double share) {
    const std::size_t stride = values.size() / quantile_samples + 1;
    std::vector<float> chosen;
    for (std::size_t i = 0; i < values.size(); i += stride)
        if (values[i] > outside) chosen.push_back(values[i]);
    if (chosen.empty()) return outside;
    const auto rank =
        std::min(chosen.size() - 1, static_cast<std::size_t>((1.0 - share) * static_cast<double>(chosen.size())));
    std::nth_element(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(rank), chosen.end());
    return chosen[rank];
}

}  // namespace

GridVolume make_cloud(const Cloud& parameters) {
    constexpr float outside = -1e30f;
    const Vec3d extent = parameters.upper - parameters.lower;
    const double longest = std::max({extent.x, extent.y, extent.z});
    GridVolume volume = fill_grid(parameters.size, parameters.lower, parameters.upper, [&](const Vec3d& at) {
        const double square = at.length2();
        if (square > 1.0) return outside;  // no noise needed
        const double value = fractal(parameters.seed, at * extent * (first_frequency / longest), parameters.octaves);
        return static_cast<float>(value - outward_thinning * square);
    });

    const float clear = upper_quantile(volume.density, outside, parameters.coverage);
    const float most = *std::max_element(volume.density.begin(), volume.density.end());
    const float scale = most > clear ? 1.0f / (most - clear) : 0.0f;
    for (float& value : volume.density) value = std::clamp((value - clear) * scale, 0.0f, 1.0f);
    return volume;
}

}  // namespace shadowbench::scene
