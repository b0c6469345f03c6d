// Piecewise-linear functions of depth. A function is its vertices in order of non-decreasing z; two (or more) vertices
// at one z are a step. It has its first value before the first vertex, its last value after the last one, and at a step
// the value before it: a surface shades only what is strictly behind it. A function without vertices is 1 everywhere.
// Visibility functions do not increase and stay in [0, 1].
#pragma once

#include <span>
#include <vector>

namespace shadowbench::curves {

struct Vertex {
    float z;
    float value;

    friend bool operator==(const Vertex&, const Vertex&) = default;
};

using Curve = std::vector<Vertex>;
using CurveView = std::span<const Vertex>;

// The value at z of the line that joins two vertices, left.z < z <= right.z. Computed in double: the difference of two
// far depths, and the product, would lose the digits that keep the result between the two values.
inline float join(const Vertex& left, const Vertex& right, float z) {
    const double share = (static_cast<double>(z) - left.z) / (static_cast<double>(right.z) - left.z);
    const double value = left.value + (static_cast<double>(right.value) - left.value) * share;
    return z == right.z ? right.value : static_cast<float>(value);
}

// The value at z. O(log vertices).
float evaluate(CurveView curve, float z);

// The limit from the right at z: the value just behind a step there.
float evaluate_behind(CurveView curve, float z);

// Whether the values never increase by more than `slack` from one vertex to the next, and stay in [-slack, 1 + slack].
bool is_visibility(CurveView curve, float slack = 0.0f);

}  // namespace shadowbench::curves
