// Makes strands of straight segments from points and curves.
#pragma once

#include <array>
#include <cstdint>

#include "scene/scene.h"

namespace shadowbench::scene {

struct StrandPoint {
    Vec3d at{0, 0, 0};
    double radius = 0.0;  // half-width
};

// The four control points of a cubic Bezier curve.
using CubicCurve = std::array<StrandPoint, 4>;

// The piece of a uniform cubic B-spline that four of its control points in a row define.
CubicCurve bezier_of_spline(const CubicCurve& control);

StrandPoint point_on(const CubicCurve& curve, double u);

class Strands {
public:
    void reserve(std::uint64_t points);
    void begin(const StrandPoint& first);
    void line_to(const StrandPoint& to);

    // The curve begins where the strand has ended. Its segments leave it by a quarter of its largest half-width at
    // most, or by a thousandth of the length of its control polygon if it has no width; but they are 64 at most.
    void curve_to(const CubicCurve& curve);

    // Whether a curve that begins here goes on with the last strand: at the same float position and width.
    bool ends_at(const StrandPoint& point) const;
    // Whatever comes next is a strand of its own.
    void close() { open_ = false; }

    std::uint64_t points() const { return hair_.points.size(); }

    // Adds all strands of others.
    void append(const Hair& others);

    Hair finish() &&;

private:
    Hair hair_;
    bool open_ = false;
};

}  // namespace shadowbench::scene
