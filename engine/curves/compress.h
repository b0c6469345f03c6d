// Greedy compression of a piecewise-linear function within a tolerance (Lokovic and Veach 2000, section 3.3).
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "curves/curve.h"

namespace shadowbench::curves {

// Writes the compressed function to `out` and returns its number of vertices, at most curve.size(). `out` must have
// room for curve.size() vertices and may be the input's own memory. The input must be a visibility function (finite, z
// non-decreasing, values non-increasing and in [0, 1]).
//  - |out(z) - curve(z)| <= tolerance for every z, on both sides of steps, up to one rounding of a float;
//  - output depths are a subset of the input's; the output is a visibility function too;
//  - O(n) time, O(1) state; the same bits with and without the instructions that take four vertices at once.
// Differences from the paper, which keep its guarantee: a segment never rises (the published middle slope can), windows
// are cut at 0, the function starts at its exact first value (nothing before all occluders is darkened), and the last
// segment aims at the exact last value. A function that is 1 everywhere has no vertices.
// The output may be compressed again with the same tolerance, and then errs by up to twice that; only with a tolerance
// of 0 does it stay the same.
std::size_t compress(CurveView curve, float tolerance, Vertex* out);

Curve compress(CurveView curve, float tolerance);

// A vertex of three functions that share their depths.
struct ColourVertex {
    float z;
    float value[3];
};

// Three functions at once (section 5.2). A segment ends where any of the three would leave its tolerance, so all have
// their vertices at the same depths. The guarantees above hold for each of them; the output depths are a subset of the
// depths of all three. `out` must have room for as many vertices as the three have together, and must not overlap them.
// O(n) for n vertices in all.
std::size_t compress(const std::array<CurveView, 3>& curves, float tolerance, ColourVertex* out);

}  // namespace shadowbench::curves
