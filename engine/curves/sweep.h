// Light rays -> the visibility function of a pixel: the weighted sum of the transmittance functions of its rays, by one
// sweep over all vertices in order of z (Lokovic and Veach 2000, sections 3.2 and 5.1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "curves/composite.h"
#include "curves/curve.h"
#include "curves/weighted_ray.h"

namespace shadowbench::rays {
struct LightRays;
}

namespace shadowbench::curves {

class RayFunctions;

// One transmittance function as a term of a weighted sum.
struct WeightedCurve {
    CurveView curve;
    double weight;
};

// The scratch memory of a sweep, reused from call to call; each thread has its own.
struct SweepScratch {
    // A linear function slope * (z - origin) + offset, already weighted.
    struct Line {
        double slope = 0.0, offset = 0.0;
    };
    // From this depth on, a term continues as another line.
    struct Event {
        Line line;
        std::uint32_t term;
        bool step;  // the term is not continuous there
    };
    std::vector<std::uint64_t> order, sorting;  // see depth_sort.h
    std::vector<std::int64_t> drops;            // surfaces: decreases of transmittance in fixed point
    std::vector<Event> events;
    std::vector<Line> sums;  // binary tree over the terms' current lines
    std::vector<Node> nodes;
    OpenMedia media;
    Curve ray;

    std::size_t bytes() const;
};

// The weighted sum of functions; `out` is replaced. Weights should sum to 1. Values in `out` are within 1e-6 of the
// exact sum, stay in [0, 1] and do not increase if the terms do not. O(n log n).
void weighted_sum(std::span<const WeightedCurve> terms, SweepScratch& scratch, Curve& out);

// The visibility function of the rays [first, first + count) of a tile in one channel, each with weight 1 / count. If
// they hit only surfaces, the result is exact to float rounding and does not depend on the order of the rays. A
// medium's exponential is evaluated at the ends of its segments and at enough points between them that joining them by
// lines errs by at most `linearisation` (> 0; infinity: only segment ends, as published).
void visibility(const rays::LightRays& rays, std::size_t first, std::size_t count, double linearisation,
                SweepScratch& scratch, Curve& out, int channel = 0);

// The same, to the bit, for a tile of one channel whose functions are made already.
void visibility(const rays::LightRays& rays, const RayFunctions& functions, std::size_t first, std::size_t count,
                double linearisation, SweepScratch& scratch, Curve& out);

// The same for rays with weights above 0, which should sum to 1. If the rays hit only surfaces, the weights are scaled
// to sum to 1.
void visibility(const rays::LightRays& rays, std::span<const WeightedRay> chosen, double linearisation,
                SweepScratch& scratch, Curve& out, int channel = 0);

}  // namespace shadowbench::curves
