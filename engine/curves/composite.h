// Segments of one ray -> its transmittance function, exact at its nodes.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "curves/curve.h"
#include "curves/open_media.h"

namespace shadowbench::rays {
struct LightRays;
}

namespace shadowbench::curves {

// A node of a transmittance function. Between two nodes the total extinction is constant, so log(value) is linear in z.
// Two nodes at one z are a step.
struct Node {
    double z;
    double value;
};

// The transmittance function of one ray and channel, with a node at every depth where a segment starts or ends or a
// surface lies. Segments that absorb nothing leave no node, and no node follows a value of 0. `out` is replaced.
// Products are in double, sums of extinction in twice that precision, so no rounding error outlives its segment; n
// overlapping media cost O(n log n). A medium's transmittance of 0 counts as the smallest normal float inside the
// segment, and as 0 behind it. Below 1e-300 log(value) need not be linear. `open` is scratch memory, reused from call
// to call.
void composite(const rays::LightRays& rays, std::size_t ray, int channel, OpenMedia& open, std::vector<Node>& out);

// Adds nodes so that joining neighbours by lines errs by at most `linearisation`; appends vertices to `out`.
void linearise(std::span<const Node> nodes, double linearisation, Curve& out);

}  // namespace shadowbench::curves
