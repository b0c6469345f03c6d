#include "scene/readers/strands.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace shadowbench::scene {
namespace {

constexpr double most_pieces = 64.0;

StrandPoint mix(const StrandPoint& a, double share_a, const StrandPoint& b, double share_b) {
    return {a.at * share_a + b.at * share_b, a.radius * share_a + b.radius * share_b};
}

// Equal steps of the parameter leave the curve by at most an eighth of its largest second derivative times the square
// of a step, and that derivative is at most six times the second difference of the control points.
int pieces_of(const CubicCurve& curve) {
    double bend = 0.0, length = 0.0, radius = 0.0;
    for (std::size_t i = 0; i + 2 < curve.size(); ++i)
        bend = std::max(bend, (curve[i].at - curve[i + 1].at * 2.0 + curve[i + 2].at).length());
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) length += (curve[i + 1].at - curve[i].at).length();
    for (const StrandPoint& point : curve) radius = std::max(radius, point.radius);
    const double tolerance = radius > 0.0 ? 0.25 * radius : 1e-3 * length;
    if (!(bend > 0.0) || !(tolerance > 0.0)) return 1;
    return static_cast<int>(std::clamp(std::ceil(std::sqrt(0.75 * bend / tolerance)), 1.0, most_pieces));
}

}  // namespace

CubicCurve bezier_of_spline(const CubicCurve& c) {
    const StrandPoint second = mix(c[1], 2.0 / 3.0, c[2], 1.0 / 3.0), third = mix(c[1], 1.0 / 3.0, c[2], 2.0 / 3.0);
    const StrandPoint before = mix(c[0], 1.0 / 3.0, c[1], 2.0 / 3.0), after = mix(c[2], 2.0 / 3.0, c[3], 1.0 / 3.0);
    return {mix(before, 0.5, second, 0.5), second, third, mix(third, 0.5, after, 0.5)};
}

StrandPoint point_on(const CubicCurve& c, double u) {
    const double v = 1.0 - u;
    const StrandPoint begin = mix(c[0], v * v * v, c[1], 3.0 * v * v * u),
                      end = mix(c[2], 3.0 * v * u * u, c[3], u * u * u);
    return mix(begin, 1.0, end, 1.0);
}

void Strands::reserve(std::uint64_t points) {
    hair_.points.reserve(static_cast<std::size_t>(points));
    hair_.radii.reserve(static_cast<std::size_t>(points));
}

void Strands::begin(const StrandPoint& first) {
    hair_.strand_begin.push_back(static_cast<std::uint32_t>(hair_.points.size()));
    open_ = true;
    line_to(first);
}

void Strands::line_to(const StrandPoint& to) {
    hair_.points.emplace_back(to.at);
    hair_.radii.push_back(static_cast<float>(to.radius));
}

void Strands::curve_to(const CubicCurve& curve) {
    const int pieces = pieces_of(curve);
    for (int i = 1; i < pieces; ++i) line_to(point_on(curve, static_cast<double>(i) / pieces));
    line_to(curve[3]);
}

bool Strands::ends_at(const StrandPoint& point) const {
    return open_ && hair_.points.back() == Vec3f(point.at) && hair_.radii.back() == static_cast<float>(point.radius);
}

void Strands::append(const Hair& others) {
    close();
    const auto offset = static_cast<std::uint32_t>(hair_.points.size());
    for (std::size_t i = 0; i + 1 < others.strand_begin.size(); ++i)
        hair_.strand_begin.push_back(offset + others.strand_begin[i]);
    hair_.points.insert(hair_.points.end(), others.points.begin(), others.points.end());
    hair_.radii.insert(hair_.radii.end(), others.radii.begin(), others.radii.end());
}

Hair Strands::finish() && {
    hair_.strand_begin.push_back(static_cast<std::uint32_t>(hair_.points.size()));
    return std::move(hair_);
}

}  // namespace shadowbench::scene
