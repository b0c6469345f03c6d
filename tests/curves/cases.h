// Functions and rays to test with, and plain oracles.
#pragma once

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <utility>
#include <vector>

#include "base/random.h"
#include "curves/curve.h"
#include "rays/light_rays.h"

namespace shadowbench::curves {

// For the reports of failures.
inline std::ostream& operator<<(std::ostream& stream, const Vertex& v) {
    return stream << v.z << ' ' << v.value;
}

}  // namespace shadowbench::curves

namespace shadowbench::curves::cases {

// Value of a function by definition, in double; O(log n).
inline double exact(CurveView curve, double z, bool behind = false) {
    if (curve.empty()) return 1.0;
    const auto in_front = [=](const Vertex& v) { return behind ? v.z <= z : v.z < z; };
    const auto right = std::partition_point(curve.begin(), curve.end(), in_front);
    if (right == curve.begin()) return right->value;
    const Vertex left = *(right - 1);
    if (right == curve.end()) return left.value;
    const double share = (z - left.z) / (static_cast<double>(right->z) - left.z);
    return left.value * (1.0 - share) + right->value * share;
}

// What separates a vertex from the one before it. Small numbers are simple, so that failures shrink to simple
// functions.
struct Move {
    int gap, drop;
};

// A visibility function out of everyday and of nasty moves: steps, neighbouring floats, denormal and huge depths.
inline Curve from_moves(int start, const std::vector<std::pair<int, int>>& moves) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const float starts[] = {1.0f, 0.0f, 1e-45f, 1e-3f, 1e6f, -5.0f};
    const float firsts[] = {1.0f, 1.0f, 0.75f};
    float z = starts[start % 6], value = firsts[start % 3];
    Curve curve;
    for (const auto& [gap, drop] : moves) {
        if (!curve.empty()) {
            const float gaps[] = {
                z, z, z + 0.01f, z + 1.0f, std::nextafter(z, kInfinity), std::max(z * 2.0f, z) + 1.0f};
            z = std::min(gaps[gap], 1e30f);
            const float values[] = {value,
                                    value - 0.02f,
                                    value - 0.001f,
                                    value * 0.9f,
                                    value * 0.5f,
                                    value * 0.0f,
                                    std::nextafter(value, 0.0f)};
            value = std::max(values[drop], 0.0f);
        }
        curve.push_back({z, value});
    }
    return curve;
}

inline rc::Gen<Curve> any_function() {
    const auto move = rc::gen::pair(rc::gen::inRange(0, 6), rc::gen::inRange(0, 7));
    return rc::gen::apply(from_moves, rc::gen::inRange(0, 6),
                          rc::gen::container<std::vector<std::pair<int, int>>>(move));
}

inline rc::Gen<float> any_tolerance() {
    return rc::gen::element(0.02f, 0.0f, 1e-7f, 1e-4f, 0.005f, 0.1f, 0.5f, 1.0f, 3.0f);
}

struct Segment {
    float front, back, through;
};

// Rays of one pixel, each a list of segments, sorted here.
inline rays::LightRays make_rays(std::vector<std::vector<Segment>> segments, bool media) {
    rays::LightRays rays;
    rays.width = rays.height = 1;
    rays.samples = static_cast<int>(segments.size());
    rays.begin.push_back(0);
    for (auto& ray : segments) {
        std::sort(ray.begin(), ray.end(), [](const Segment& a, const Segment& b) {
            return a.front != b.front ? a.front < b.front : a.back < b.back;
        });
        for (const Segment& segment : ray) {
            rays.z_front.push_back(segment.front);
            if (media) rays.z_back.push_back(segment.back);
            rays.transmittance.push_back(segment.through);
        }
        rays.begin.push_back(static_cast<std::uint32_t>(rays.z_front.size()));
    }
    return rays;
}

inline float number(base::Random& random, double low, double high) {
    return static_cast<float>(random.uniform(low, high));
}

// `hits` surfaces of opacity up to `opacity` at random depths in [low, high); some depths are shared between rays.
inline std::vector<Segment> random_surfaces(base::Random& random, int hits, double low, double high, double opacity) {
    std::vector<Segment> ray;
    for (int i = 0; i < hits; ++i) {
        float z = number(random, low, high);
        if (random.below(4) == 0) z = std::round(z);
        ray.push_back({z, z, 1.0f - number(random, 0.0, opacity)});
    }
    return ray;
}

inline std::vector<Segment> random_media(base::Random& random, int count, double low, double high) {
    std::vector<Segment> ray;
    for (int i = 0; i < count; ++i) {
        const float a = number(random, low, high), b = number(random, low, high);
        ray.push_back({std::min(a, b), std::max(a, b), number(random, 0.05, 1.0)});
    }
    return ray;
}

// The oracle of a pixel: mean transmittance of all rays up to z; just behind z if asked.
inline double exact(const rays::LightRays& rays, double z, bool behind = false) {
    if (behind) z = std::nextafter(z, std::numeric_limits<double>::infinity());
    double sum = 0.0;
    for (std::size_t ray = 0; ray < rays.rays(); ++ray) sum += rays::transmittance(rays, ray, 0, z);
    return sum / static_cast<double>(rays.rays());
}

}  // namespace shadowbench::curves::cases
