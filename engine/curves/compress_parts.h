// Shared by the two compressions: reading one function or three as control points, and writing the result. Internal to
// compress.cpp and compress_published.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "curves/compress.h"

namespace shadowbench::curves::compression {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

// One function, or three that are compressed together.
template <int channels>
using Values = std::array<double, channels>;

// All vertices at one z: the values on both sides.
template <int channels>
struct Group {
    double z = 0.0;
    Values<channels> before, after;
};

struct OneReader {
    CurveView curve;
    std::size_t next = 0;

    bool more() const { return next < curve.size(); }
    Group<1> read() {
        const Vertex first = curve[next++];
        float after = first.value;
        while (next < curve.size() && curve[next].z == first.z) after = curve[next++].value;
        return {first.z, {first.value}, {after}};
    }
};

// Reads groups at every depth where one of the three functions has a vertex.
struct ColourReader {
    std::array<OneReader, 3> channel;
    Group<1> last[3];  // what each channel read last

    explicit ColourReader(const std::array<CurveView, 3>& curves) {
        for (int c = 0; c < 3; ++c) {
            channel[c].curve = curves[c];
            const double start = curves[c].empty() ? 1.0 : curves[c].front().value;
            last[c] = {-kInfinity, {start}, {start}};
        }
    }
    bool more() const { return channel[0].more() || channel[1].more() || channel[2].more(); }
    Group<3> read() {
        int first = -1;
        for (int c = 0; c < 3; ++c)
            if (channel[c].more() && (first < 0 || depth(c) < depth(first))) first = c;
        const float z = depth(first);
        Group<3> group{z, {}, {}};
        for (int c = 0; c < 3; ++c) {
            if (c == first || (channel[c].more() && depth(c) == z)) {
                last[c] = channel[c].read();
                group.before[c] = last[c].before[0];
                group.after[c] = last[c].after[0];
            } else {
                group.before[c] = group.after[c] = between(c, z);
            }
        }
        return group;
    }

private:
    float depth(int c) const { return channel[c].curve[channel[c].next].z; }
    // The value of channel c at a depth where it has no vertex.
    double between(int c, double z) const {
        const double from = last[c].after[0];
        if (!channel[c].more() || last[c].z == -kInfinity) return from;
        const Vertex to = channel[c].curve[channel[c].next];
        const double value = from + (to.value - from) * ((z - last[c].z) / (to.z - last[c].z));
        return std::max(value, std::min<double>(from, to.value));
    }
};

inline void write(Vertex& vertex, float z, const std::array<float, 1>& values) {
    vertex = {z, values[0]};
}
inline void write(ColourVertex& vertex, float z, const std::array<float, 3>& values) {
    vertex = {z, {values[0], values[1], values[2]}};
}

// Rounds to float. Three channels need `volatile`, or GCC 12 for x86-64 drops the rounding of two of them at -O2 and
// above. It joins two neighbouring conversions to float and back into conversions of vectors and takes those for none:
//     void round(double* a) { float x = a[0], y = a[1]; a[0] = x; a[1] = y; }
// compiles to an empty function. tests/curves/rounding_test.cpp has this case.
template <int channels>
float to_float(double aim_of_channel) {
    if constexpr (channels == 1) return static_cast<float>(aim_of_channel);
    const volatile float rounded = static_cast<float>(aim_of_channel);
    return rounded;
}

}  // namespace shadowbench::curves::compression
