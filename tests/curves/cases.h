// Functions and rays to test with, and plain oracles.
#pragma once

#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ostream>
#include <utility>
#include <vector>

#include "adversarial.h"
#include "base/random.h"
#include "curves/compress.h"
#include "curves/curve.h"
#include "rays/light_rays.h"

namespace shadowbench::curves {

// For the reports of failures.
inline std::ostream& operator<<(std::ostream& stream, const Vertex& v) {
    return stream << v.z << ' ' << v.value;
}

}  // namespace shadowbench::curves

namespace shadowbench::rays {

inline std::ostream& operator<<(std::ostream& stream, const LightRays& rays) {
    stream.precision(9);
    for (std::size_t ray = 0; ray < rays.rays(); ++ray)
        for (std::size_t s = rays.begin[ray]; s < rays.begin[ray + 1]; ++s)
            stream << "ray " << ray << " from " << rays.z_front[s] << " to " << rays.back(s) << " lets "
                   << rays.transmittance[s] << " through\n";
    return stream;
}

}  // namespace shadowbench::rays

namespace shadowbench::curves::cases {

// The value of a function by definition, in double; O(log n).
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

// The step from a vertex to the next one. Small numbers are simple, so that failures shrink to simple functions.
// functions.
struct Move {
    int gap, drop;
};

// A visibility function from everyday and nasty moves: steps, neighbouring floats, denormal and huge depths.
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

// RapidCheck's numbers and lists grow with the case; here only the lists do, up to 40 moves.
template <class T>
rc::Gen<T> full_range(rc::Gen<T> gen) {
    return rc::gen::resize(rc::kNominalSize, std::move(gen));
}

inline rc::Gen<Curve> any_function() {
    const auto move = full_range(rc::gen::pair(rc::gen::inRange(0, 6), rc::gen::inRange(0, 7)));
    const auto moves = rc::gen::scale(0.4, rc::gen::container<std::vector<std::pair<int, int>>>(move));
    return rc::gen::apply(from_moves, full_range(rc::gen::inRange(0, 6)), moves);
}

// A function made to be hard on this tolerance.
inline rc::Gen<Curve> any_adversarial_function(float tolerance) {
    const auto piece = rc::gen::apply(
        [](int stretch, int length, std::uint64_t seed) {
            return Piece{stretch, length, seed};
        },
        rc::gen::inRange(0, kStretches), rc::gen::inRange(1, 9), rc::gen::inRange<std::uint64_t>(0, 1000));
    const auto pieces = rc::gen::scale(0.05, rc::gen::container<std::vector<Piece>>(full_range(piece)));
    return rc::gen::apply(
        [=](int start, const std::vector<Piece>& some) { return from_pieces(tolerance, start, some); },
        full_range(rc::gen::inRange(0, 49)), pieces);
}

inline rc::Gen<float> any_tolerance() {
    return rc::gen::element(0.02f, 0.0f, 1e-7f, 1e-4f, 0.005f, 0.1f, 0.5f, 1.0f, 3.0f);
}

// A function and the tolerance to compress it with.
struct Case {
    Curve curve;
    float tolerance;
};

inline std::ostream& operator<<(std::ostream& stream, const Case& c) {
    stream << "tolerance " << c.tolerance;
    for (const Vertex& v : c.curve) stream << ", " << v.z << ' ' << v.value;
    return stream;
}

inline rc::Gen<Case> any_case() {
    return rc::gen::mapcat(any_tolerance(), [](float tolerance) {
        return rc::gen::map(rc::gen::oneOf(any_function(), any_adversarial_function(tolerance)), [=](Curve curve) {
            return Case{std::move(curve), tolerance};
        });
    });
}

// Three functions at once, often with depths in common.
struct ColourCase {
    std::array<Curve, 3> curve;
    float tolerance;

    std::array<CurveView, 3> views() const { return {curve[0], curve[1], curve[2]}; }
    std::size_t vertices() const { return curve[0].size() + curve[1].size() + curve[2].size(); }
};

inline std::ostream& operator<<(std::ostream& stream, const ColourCase& c) {
    for (const Curve& curve : c.curve) stream << Case{curve, c.tolerance} << '\n';
    return stream;
}

inline rc::Gen<ColourCase> any_three() {
    return rc::gen::mapcat(any_tolerance(), [](float tolerance) {
        const auto one = rc::gen::oneOf(any_function(), any_adversarial_function(tolerance));
        return rc::gen::apply(
            [=](Curve r, Curve g, Curve b, bool together) {
                for (std::size_t i = 0; together && i < std::min(r.size(), g.size()); ++i) g[i].z = r[i].z;
                if (together && g.size() > r.size()) g.resize(r.size());
                return ColourCase{{std::move(r), std::move(g), std::move(b)}, tolerance};
            },
            one, one, one, rc::gen::arbitrary<bool>());
    });
}

inline Curve channel(const std::vector<ColourVertex>& vertices, int c) {
    Curve curve;
    for (const ColourVertex& v : vertices) curve.push_back({v.z, v.value[c]});
    return curve;
}

// The error that rounding may add: one unit in the last place of the largest value, and the slack of compress() at its
// end, which matters only for functions as faint as it is.
inline double rounding_of(CurveView curve) {
    return 0x1p-24 * (curve.empty() ? 1.0f : curve.front().value) + 0x1p-48;
}

// The same function with depths multiplied by 2^power. Returns false if a float cannot hold it.
inline bool scale_depths(Curve& curve, int power) {
    for (Vertex& v : curve) {
        const float scaled = std::ldexp(v.z, power);
        if (std::ldexp(scaled, -power) != v.z) return false;
        v.z = scaled;
    }
    return true;
}

// The rays of one pixel, each a list of segments, sorted here; segments at the same depths keep their order.
inline rays::LightRays make_rays(std::vector<std::vector<Segment>> segments, bool media) {
    rays::LightRays rays;
    rays.width = rays.height = 1;
    rays.samples = static_cast<int>(segments.size());
    rays.begin.push_back(0);
    for (auto& ray : segments) {
        std::stable_sort(ray.begin(), ray.end(), [](const Segment& a, const Segment& b) {
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

// The oracle of a pixel: the mean transmittance of all rays up to z; just behind z if asked.
inline double exact(const rays::LightRays& rays, double z, bool behind = false) {
    if (behind) z = std::nextafter(z, std::numeric_limits<double>::infinity());
    double sum = 0.0;
    for (std::size_t ray = 0; ray < rays.rays(); ++ray) sum += rays::transmittance(rays, ray, 0, z);
    return sum / static_cast<double>(rays.rays());
}

}  // namespace shadowbench::curves::cases
