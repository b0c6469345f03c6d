// Converts optical depths to the float transmittances of light rays. A single exp and a single rounding would lose
// steps that are too faint to differ from 1, and the extinction of steps too dark to differ from 0.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/vec.h"
#include "rays/exp_minus.h"

namespace shadowbench::rays {

// The next depth that a float can hold: the least end of a segment.
inline float next_depth(float z) {
    return std::nextafter(z, std::numeric_limits<float>::infinity());
}

// Rounds the transmittances of consecutive segments to float so that their product stays with the exact one, however
// many there are: each segment corrects the rounding error of those before it.
class StepRounding {
public:
    // The transmittance in one channel of a segment with this optical depth, at most `darkest`. If it is 1, the depth
    // is carried to the segments behind.
    float transmittance(int channel, double depth) {
        double& rest = rest_[static_cast<std::size_t>(channel)];
        depth += rest;
        const double exact = exp_minus(std::min(depth, most_depth));
        const float rounded = std::min(static_cast<float>(exact), 1.0f);
        rest = rounded == 1.0f ? depth : (rounded - exact) / exact;  // the logarithm of their ratio, to first order
        return rounded;
    }

private:
    std::array<double, 3> rest_{};  // optical depth that the floats so far have not included
};

// The optical depth behind which nothing matters. Its transmittance is still a normal float, also after the little that
// rounding a depth may add.
constexpr double darkest = 80.0, black = 85.0;

// Inside a segment the logarithm of the transmittance is linear, so a segment that ends at 0 would have no finite
// extinction. Such a segment is cut where a channel reaches `darkest`; behind its cut a channel transmits 0. `depth` is
// per unit of extinction, front < back. Calls add(front, back, transmittances) for the parts from front to back; each
// is at least one float long.
template <class Add>
void cut_where_dark(float front, float back, double depth, const base::Vec3f& extinction, const Add& add) {
    std::array<double, 3> cut;
    for (int c = 0; c < 3; ++c) cut[static_cast<std::size_t>(c)] = std::min(depth, darkest / extinction[c]);
    std::array<double, 4> ends{cut[0], cut[1], cut[2], depth};
    std::sort(ends.begin(), ends.end());

    const double length = static_cast<double>(back) - front;
    const float last = std::nextafter(back, -std::numeric_limits<float>::infinity());
    double begin = 0.0;  // optical depth at which the part begins
    float z = front;
    for (const double end : ends) {
        if (end <= begin) continue;
        const float next = end < depth ? std::min(static_cast<float>(front + length * (end / depth)), last) : back;
        const float to = std::max(next, next_depth(z));
        const double part = depth * ((static_cast<double>(to) - z) / length);
        float t[3];
        for (std::size_t c = 0; c < 3; ++c)
            t[c] = begin < cut[c]
                       ? static_cast<float>(std::exp(-std::min(part * extinction[static_cast<int>(c)], black)))
                       : 0.0f;
        add(z, to, t);
        begin = end;
        z = next;
    }
}

}  // namespace shadowbench::rays
