#include <algorithm>
#include <cmath>
#include <limits>

#include "curves/composite.h"

namespace shadowbench::curves {

namespace {

// One exponential piece from `a` to `b`, a.z < b.z.
struct Piece {
    Node a, b;
    double optical_depth;

    double depth_of(double value) const { return a.z + (b.z - a.z) * std::log(a.value / value) / optical_depth; }
    double value_at(float z) const {  // at the rounded depth, since the function may be steep
        return a.value * std::exp(-optical_depth * ((z - a.z) / (b.z - a.z)));
    }
};

// Used where a step of sqrt(T) spans so few floats that rounding its ends would make it notably longer. Each step
// starts from the vertex written last and ends at a float within its reach, or at the next float. `out` ends with the
// piece's first vertex.
void place_on_floats(const Piece& piece, double low, double step, Curve& out) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (double value = piece.a.value; value > low * low;) {
        const double reached = piece.depth_of(std::pow(std::max(std::sqrt(value) - step, low), 2));
        const float next = std::nextafter(out.back().z, kInfinity);
        float z = static_cast<float>(std::min(reached, piece.b.z));
        if (z > reached) z = std::nextafter(z, -kInfinity);
        z = std::max(z, next);
        if (!(z < piece.b.z)) return;
        value = piece.value_at(z);
        out.push_back({z, static_cast<float>(value)});
    }
}

// Places the inner vertices of a piece.
//
// The chord over optical depth D that starts at value T errs by T (1 - m + m ln m), m = (1 - exp(-D)) / D, which is
// about T D^2 / 8: half the square of the step of sqrt(T). So equal steps of sqrt(T) spend the error evenly. The error
// exceeds that half square by at most 2.1 % for the steps taken here (D < 1.75), hence 1.95 instead of 2. Where the
// value is below the error allowed, one chord goes to the end.
void subdivide(const Node& a, const Node& b, double error, Curve& out) {
    const double drop = a.value - b.value;
    if (a.value <= error || drop * drop <= 8.0 * b.value * error) return;  // D <= (T0 - T1) / sqrt(T0 T1): no logarithm
    const Piece piece{a, b, std::log(a.value / std::max(b.value, std::numeric_limits<double>::min()))};
    const double high = std::sqrt(a.value), low = std::sqrt(std::max(b.value, error)), step = std::sqrt(1.95 * error);
    // The first step is the shortest, about 2 step / high of optical depth.
    const double shortest = (b.z - a.z) * 2.0 * step / (high * piece.optical_depth);
    const double spacing = std::max(0x1p-24 * std::max(std::abs(a.z), std::abs(b.z)), 0x1p-149);  // of floats
    if (shortest < 128.0 * spacing) return place_on_floats(piece, low, step, out);
    const double pieces = std::ceil((high - low) / step);
    const int count = static_cast<int>(pieces);
    const int last = b.value < error ? count : count - 1;
    for (int i = 1; i <= last; ++i) {
        const double root = high + (low - high) * (i / pieces);
        const float z = static_cast<float>(piece.depth_of(root * root));
        if (z > out.back().z && z < b.z) out.push_back({z, static_cast<float>(piece.value_at(z))});
    }
}

}  // namespace

void linearise(std::span<const Node> nodes, double linearisation, Curve& out) {
    const double error = std::max(linearisation, 0x1p-24);  // finer than floats can resolve
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (i > 0 && nodes[i].z > nodes[i - 1].z && linearisation < 1.0) subdivide(nodes[i - 1], nodes[i], error, out);
        const Vertex vertex{static_cast<float>(nodes[i].z), static_cast<float>(nodes[i].value)};
        if (i == 0 || !(out.back() == vertex)) out.push_back(vertex);
    }
}

}  // namespace shadowbench::curves
