#include <algorithm>
#include <cmath>
#include <limits>

#include "curves/composite.h"

namespace shadowbench::curves {

namespace {

constexpr double kFinest = 1.95;  // of 2: see subdivide

// The same where pieces are so short that the rounding of a depth to float makes some of them longer than they may be:
// one after the other, each from the vertex before as it was rounded, its end rounded towards that. A piece is one
// float long at least, whatever it errs by between two depths that no float holds.
void subdivide_short(const Node& a, const Node& b, double error, double optical_depth, Curve& out) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const double step = std::sqrt(kFinest * error), last = b.value < error ? 0.0 : std::sqrt(b.value);
    double value = a.value;
    float z = out.back().z;
    while (value > error) {
        const double root = std::max(std::sqrt(value) - step, std::sqrt(error));
        if (root <= last) return;
        const double end = a.z + (b.z - a.z) * std::log(a.value / (root * root)) / optical_depth;
        float next = static_cast<float>(end);
        if (next > end) next = std::nextafter(next, -infinity);
        z = std::max(next, std::nextafter(z, infinity));
        if (!(z < b.z)) return;
        value = a.value * std::exp(-optical_depth * ((z - a.z) / (b.z - a.z)));
        out.push_back({z, static_cast<float>(value)});
    }
}

// Inner vertices of one exponential piece from `a` to `b`, a.z < b.z.
//
// The chord over optical depth D that starts at value T errs by T (1 - m + m ln m), m = (1 - exp(-D)) / D, which is
// about T D^2 / 8: half the square of the step of sqrt(T). So equal steps of sqrt(T) spend the error evenly. The bound
// exceeds that half square by 2.1 % at most for the steps taken here (D < 1.75), whence 1.95 instead of 2. Where the
// value itself is below the error allowed, one chord goes to the end.
void subdivide(const Node& a, const Node& b, double error, Curve& out) {
    const double drop = a.value - b.value;
    if (a.value <= error || drop * drop <= 8.0 * b.value * error) return;  // D <= (T0 - T1) / sqrt(T0 T1): no logarithm
    const double optical_depth = std::log(a.value / std::max(b.value, std::numeric_limits<double>::min()));
    const double high = std::sqrt(a.value), low = std::sqrt(std::max(b.value, error));
    const double pieces = std::ceil((high - low) / std::sqrt(kFinest * error));
    const double longest_float = 0x1p-23 * std::max(std::abs(a.z), std::abs(b.z));
    if (b.z - a.z < 128.0 * pieces * longest_float) return subdivide_short(a, b, error, optical_depth, out);
    const int count = static_cast<int>(pieces);
    const int last = b.value < error ? count : count - 1;
    for (int i = 1; i <= last; ++i) {
        const double root = high + (low - high) * (i / pieces);
        const float z = static_cast<float>(a.z + (b.z - a.z) * std::log(a.value / (root * root)) / optical_depth);
        if (!(z > out.back().z && z < b.z)) continue;  // no float is left between
        const double share = (z - a.z) / (b.z - a.z);  // of the rounded depth: the function may be steep
        out.push_back({z, static_cast<float>(a.value * std::exp(-optical_depth * share))});
    }
}

}  // namespace

void linearise(const std::vector<Node>& nodes, double linearisation, Curve& out) {
    const double error = std::max(linearisation, 0x1p-24);  // finer than a float tells apart
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (i > 0 && nodes[i].z > nodes[i - 1].z && linearisation < 1.0) subdivide(nodes[i - 1], nodes[i], error, out);
        const Vertex vertex{static_cast<float>(nodes[i].z), static_cast<float>(nodes[i].value)};
        if (i == 0 || !(out.back() == vertex)) out.push_back(vertex);
    }
}

}  // namespace shadowbench::curves
