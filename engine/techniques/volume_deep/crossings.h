// One texel of volume_deep: how it is made from accumulated opacity, and how it is evaluated (sections "Implementation"
// of the paper: steps 5 and 6 of the map's routine, and the paragraph on its lookup).
#pragma once

#include <algorithm>
#include <array>
#include <span>

namespace shadowbench::techniques {

enum class Crossing {
    smooth,  // inside the step, placed by smooth step
    bucket,  // at the end of the last step before the crossing
};

// A threshold that is never reached has the depth where the ray leaves the last step in which it lost light: there the
// opacity is the maximum, which belongs to that depth. So no depth in the texel means "none": below a total of 10 %,
// the ray is lit up to its exit and has the maximum behind it; an empty ray has a maximum of 0.
struct Crossings {
    std::array<float, 3> depth;  // at 10, 50 and 90 % opacity; do not decrease
    float most;                  // opacity at the exit
};

constexpr std::array<double, 3> thresholds = {0.1, 0.5, 0.9};

// 3 t^2 - 2 t^3 for t in [0, 1].
inline double smooth_step(double t) {
    return t * t * (3.0 - 2.0 * t);
}

// Makes the texel of a ray whose opacity at the end of step i is opacity[i], not decreasing, and whose step i reaches
// from depth(i) to depth(i + 1).
template <class Depth>
Crossings make_crossings(std::span<const double> opacity, const Depth& depth, Crossing placed) {
    Crossings result{{depth(0), depth(0), depth(0)}, 0.0f};
    std::size_t next = 0;
    double before = 0.0;
    int exit = 0;
    for (int i = 0; i < static_cast<int>(opacity.size()); ++i) {
        const double behind = opacity[i];
        if (behind == before) continue;
        exit = i + 1;
        for (; next < thresholds.size() && behind >= thresholds[next]; ++next) {
            const double low = depth(i), high = depth(i + 1);
            const double t = smooth_step((thresholds[next] - before) / (behind - before));
            result.depth[next] = static_cast<float>(placed == Crossing::smooth ? low + (high - low) * t : low);
        }
        before = behind;
    }
    for (; next < thresholds.size(); ++next) result.depth[next] = depth(exit);
    result.most = static_cast<float>(before);
    return result;
}

// The opacity that belongs to crossing i: the threshold, or the maximum if that is less.
inline double opacity_at(const Crossings& c, std::size_t i) {
    return std::min(thresholds[i], static_cast<double>(c.most));
}

// Visibility at z: 1 up to the first depth, 1 - most behind the last, and between two depths a smooth step between
// their values. In double, so that it does not rise by rounding.
inline float visibility(const Crossings& c, float z) {
    if (!(z > c.depth[0])) return 1.0f;
    if (z > c.depth[2]) return 1.0f - c.most;
    const std::size_t i = z > c.depth[1] ? 1 : 0;
    const double low = c.depth[i], high = c.depth[i + 1];
    const double t = smooth_step((static_cast<double>(z) - low) / (high - low));
    const double from = opacity_at(c, i), to = opacity_at(c, i + 1);
    return static_cast<float>(1.0 - (from + (to - from) * t));
}

// The visibility just behind crossing i, which is the last one at its depth.
inline float visibility_behind(const Crossings& c, std::size_t i) {
    return i == 2 ? 1.0f - c.most : static_cast<float>(1.0 - opacity_at(c, i));
}

}  // namespace shadowbench::techniques
