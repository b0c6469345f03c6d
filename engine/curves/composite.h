// Segments of one ray -> its transmittance function, exact at its nodes.
#pragma once

#include <cstddef>
#include <vector>

#include "curves/curve.h"

namespace shadowbench::rays {
struct LightRays;
}

namespace shadowbench::curves {

// A node of a transmittance function: between two nodes the total extinction is constant, so log(value) is linear in z.
// Two nodes at one z are a step.
struct Node {
    double z;
    double value;
};

// Transmittance function of one ray and channel at every depth where something starts, ends or stands; what absorbs
// nothing leaves no node, and nothing follows a value of 0. `out` is replaced. Products are in double, sums of
// extinction in twice that, so no rounding error outlives its segment; n overlapping media cost O(n log n). A medium's
// transmittance of 0 counts as the smallest normal float inside the segment, and as 0 behind it. Below 1e-300
// log(value) need not be linear.
void composite(const rays::LightRays& rays, std::size_t ray, int channel, std::vector<Node>& out);

// Adds nodes so that joining neighbours by lines errs by at most `linearisation`; appends to `out` as vertices.
void linearise(const std::vector<Node>& nodes, double linearisation, Curve& out);

}  // namespace shadowbench::curves
