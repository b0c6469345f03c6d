// Greedy compression exactly as published (Lokovic and Veach 2000, section 3.3), beside the corrected one of
// compress.h.
#pragma once

#include "curves/compress.h"

namespace shadowbench::curves {

// Like compress(), except that the input may rise, and for the guarantees on the output:
//
// The published text. The origin of the first segment is the first vertex. Every further vertex (z, v) narrows the
// range of slopes from the origin to those that pass between (z, v - tolerance) and (z, v + tolerance). When that would
// leave none, a segment with the middle slope ends at the z of the last vertex that was passed; its end is the next
// origin. The last segment ends likewise at the last vertex. Nothing is cut at 0 or 1, and segments may rise.
//
// The text leaves two points open. They are filled in as plainly as possible:
//  - A vertex at the origin's own z, where its range of slopes is 0 / 0: within the tolerance of the origin every
//    slope passes it, otherwise only the vertical does. The vertical passes all vertices at that z; its middle is the
//    last one's value.
//  - Slopes are double; the origin is the vertex as written, rounded to float.
//
// The output is within the tolerance of the input, up to one rounding. That of a visibility function is never above 1;
// it may rise by up to twice the tolerance and fall below 0 by up to the tolerance.
std::size_t compress_published(CurveView curve, float tolerance, Vertex* out);

Curve compress_published(CurveView curve, float tolerance);

// Three functions at once: their vertices are the union of the depths of all, with the values on both sides of each.
std::size_t compress_published(const std::array<CurveView, 3>& curves, float tolerance, ColourVertex* out);

}  // namespace shadowbench::curves
