// Uniform intervals of depth, and the optical depth that the segments of a ray add to each.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "rays/light_rays.h"

namespace shadowbench::techniques {

// The optical depth of a segment that transmits `through`, at most `most`.
inline double optical_depth(float through, double most) {
    return through > 0.0f ? std::min(-static_cast<double>(std::log(through)), most) : most;
}

// Interval i of `count` reaches from depth(i) to depth(i + 1). If low and high are equal or nearly so (all depths
// denormal) the scale is infinite: then everything behind `near` is behind all intervals.
struct Slices {
    float near = 0.0f;
    float scale = 0.0f;  // intervals per unit of depth
    int count = 1;

    Slices() = default;
    Slices(float low, float high, int intervals)
        : near(low),
          scale(static_cast<float>(intervals / (static_cast<double>(high) - static_cast<double>(low)))),
          count(intervals) {}

    // In [0, count], never falling with z. A NaN lies before everything.
    float place(float z) const {
        const float u = (z - near) * scale;
        return u > 0.0f ? std::min(u, static_cast<float>(count)) : 0.0f;
    }
    int interval(float place) const { return std::min(static_cast<int>(place), count - 1); }
    float depth(int i) const { return static_cast<float>(near + i / static_cast<double>(scale)); }
    // A depth behind all intervals, as near to the last one as the roundings of place() allow.
    float behind() const {
        const double range = count / static_cast<double>(scale);
        return std::nextafter(static_cast<float>(near + range * (1.0 + 0x1p-21)),
                              std::numeric_limits<float>::infinity());
    }

    // Calls add(interval, part) for the parts of a segment of constant extinction. A surface goes as a whole into the
    // interval that begins at its depth or before: it counts at the slice where that interval ends, not at the slice at
    // its own depth.
    template <class Add>
    void spread(float front, float back, double depth_of_segment, const Add& add) const {
        const int first = interval(place(front));
        if (front == back) return add(first, depth_of_segment);
        const float end = place(back);
        int last = interval(end);
        if (last > first && end == static_cast<float>(last)) --last;  // it ends where that interval begins
        if (first == last || !std::isfinite(scale)) return add(first, depth_of_segment);
        const double u0 = (static_cast<double>(front) - near) * scale, u1 = (static_cast<double>(back) - near) * scale;
        const double rate = depth_of_segment / (u1 - u0);
        double rest = depth_of_segment;
        const auto give = [&](int i, double part) {
            part = std::clamp(part, 0.0, rest);
            rest -= part;
            add(i, part);
        };
        give(first, rate * (first + 1 - u0));
        for (int i = first + 1; i < last; ++i) give(i, rate);
        add(last, rest);
    }

    // The same for all segments of a ray; returns the last interval with optical depth, or -1 if there is none.
    template <class Add>
    int spread_ray(const rays::LightRays& rays, std::size_t ray, double most, const Add& add) const {
        int last = -1;
        for (std::uint32_t s = rays.begin[ray]; s < rays.begin[ray + 1]; ++s) {
            if (rays.transmittance[s] >= 1.0f) continue;
            spread(rays.z_front[s], rays.back(s), optical_depth(rays.transmittance[s], most), [&](int i, double part) {
                add(i, part);
                last = std::max(last, i);
            });
        }
        return last;
    }
};

}  // namespace shadowbench::techniques
