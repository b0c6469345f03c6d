// Greedy compression of a piecewise-linear function within a tolerance (Lokovic and Veach 2000, section 3.3).
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "curves/curve.h"

namespace shadowbench::curves {

// Writes the compressed function to `out` and returns its number of vertices, at most curve.size(); `out` must have
// room for curve.size() vertices and may be the input's own memory. The input must be a visibility function (finite, z
// non-decreasing, values non-increasing and in [0, 1]).
//  - |out(z) - curve(z)| <= tolerance for every z, on both sides of steps, up to one rounding of a float;
//  - output depths are a subset of the input's; the output is a visibility function too;
//  - O(n) time, O(1) state.
// Differences from the paper, which keep its guarantee: a segment never rises (the published middle slope can), windows
// are cut at 0, the function starts at its exact first value (what is in front of all is not darkened), and the last
// segment aims at the exact last value. No vertices come out where the function is 1 everywhere.
// What came out may be compressed further with the same tolerance, and then errs by up to twice that; only a tolerance
// of 0 gives the same again.
std::size_t compress(CurveView curve, float tolerance, Vertex* out);

Curve compress(CurveView curve, float tolerance);

// A vertex of three functions that share their depths.
struct ColourVertex {
    float z;
    float value[3];
};

// Three functions at once (section 5.2): a segment ends where any of the three would leave its tolerance, so all have
// their vertices at the same depths. What is promised above holds for each of them; the depths are a subset of those of
// all three together. `out` must have room for as many vertices as the three have together, in other memory than
// theirs. O(n) for n vertices of all.
std::size_t compress(const std::array<CurveView, 3>& curves, float tolerance, ColourVertex* out);

}  // namespace shadowbench::curves
