#include "scene/polygon/triangulate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "scene/polygon/sweep_polygon.h"

namespace shadowbench::scene {
namespace {

constexpr double float_step = 1.0 / (1 << 23);  // of a number near 1

bool less(const Vec3f& a, const Vec3f& b) {
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
}

// Where a closed list of corners begins when it is written in its least order. The result does not depend on the corner
// that the list begins with (the minimal rotation of a word; Y. Shiloach, "Fast canonization of circular strings",
// Journal of Algorithms 2, 1981).
std::size_t least_rotation(const std::vector<Vec3f>& word) {
    const std::size_t n = word.size();
    std::size_t i = 0, j = 1, same = 0;
    while (i < n && j < n && same < n) {
        const Vec3f &a = word[(i + same) % n], &b = word[(j + same) % n];
        if (a == b) {
            ++same;
            continue;
        }
        (less(b, a) ? i : j) += same + 1;
        if (i == j) ++j;
        same = 0;
    }
    return std::min(i, j);
}

// The polygon from its least corner on, without corners that repeat the one before, seen along its normal.
struct View {
    std::vector<std::uint32_t> corner;  // the index of each in the polygon
    std::vector<Vec3d> offset;          // from the first corner
    double rounding = 0.0;              // the rounding that floats leave in the offsets
    double perimeter = 0.0;
    Vec3d normal{0, 0, 0};  // unit length; 0 if all corners lie on one line
    std::vector<GridPoint> grid;
    double cell = 0.0;  // the grid's step

    std::size_t size() const { return corner.size(); }
};

void order_corners(const Polygon& polygon, View& view) {
    std::vector<Vec3f> distinct;
    const std::size_t count = polygon.positions.size();
    for (std::size_t i = 0; i < count; ++i) {
        if (polygon.positions[i] == polygon.positions[(i + count - 1) % count]) continue;
        view.corner.push_back(static_cast<std::uint32_t>(i));
        distinct.push_back(polygon.positions[i]);
    }
    if (distinct.empty()) return;
    const std::size_t first = least_rotation(distinct);
    std::rotate(view.corner.begin(), view.corner.begin() + static_cast<std::ptrdiff_t>(first), view.corner.end());
    double largest = 0.0;
    for (const std::uint32_t corner : view.corner) {
        const Vec3d at(polygon.positions[corner]);
        view.offset.push_back(at - Vec3d(distinct[first]));
        largest = std::max({largest, std::abs(at.x), std::abs(at.y), std::abs(at.z)});
    }
    view.rounding = 2.0 * float_step * largest;
    for (std::size_t i = 0; i < view.size(); ++i)
        view.perimeter += (view.offset[(i + 1) % view.size()] - view.offset[i]).length();
}

// Newell's normal, whose length is twice the area. Where it may be rounding only, as for a symmetric bow tie, takes the
// normal of the three corners that span most with the first one.
void find_normal(View& view) {
    Vec3d newell(0, 0, 0);
    for (std::size_t i = 1; i + 1 < view.size(); ++i) newell += view.offset[i].cross(view.offset[i + 1]);
    view.normal = newell;
    if (!(newell.length() > view.rounding * view.perimeter)) {
        const Vec3d farthest = *std::max_element(view.offset.begin(), view.offset.end(),
                                            [](const Vec3d& a, const Vec3d& b) { return a.length2() < b.length2(); });
        Vec3d widest(0, 0, 0);
        for (const Vec3d& offset : view.offset)
            if (farthest.cross(offset).length2() > widest.length2()) widest = farthest.cross(offset);
        constexpr double on_one_line = 1e-12;  // far above the rounding of a cross product in double
        if (!(widest.length() > on_one_line * farthest.length2())) widest = Vec3d(0, 0, 0);
        view.normal = widest.dot(newell) < 0.0 ? -widest : widest;
    }
    view.normal.normalize();
}

void project(View& view) {
    const Vec3d& n = view.normal;
    // In a plane perpendicular to a world axis, u and v are world axes: corners on one line along an axis stay on one
    // line on the grid.
    Vec3d axis(0, 0, 0);
    const double least = std::min({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
    (std::abs(n.x) == least ? axis.x : std::abs(n.y) == least ? axis.y : axis.z) = 1.0;
    const Vec3d u = n.cross(axis).normalized(), v = n.cross(u);
    std::vector<Vec2d> flat;
    Vec2d lower(0, 0), upper(0, 0);
    for (const Vec3d& offset : view.offset) {
        const Vec2d at(offset.dot(u), offset.dot(v));
        flat.push_back(at);
        lower = Vec2d(std::min(lower.x, at.x), std::min(lower.y, at.y));
        upper = Vec2d(std::max(upper.x, at.x), std::max(upper.y, at.y));
    }
    const Vec2d extent = upper - lower;
    view.cell = std::max(extent.x, extent.y) / static_cast<double>(max_grid);
    for (const Vec2d& at : flat)
        view.grid.push_back({std::llround((at.x - lower.x) / view.cell), std::llround((at.y - lower.y) / view.cell)});
}

// Whether the outline turns left at every corner, and once around.
bool is_convex(const std::vector<GridPoint>& outline) {
    const std::size_t n = outline.size();
    int reversals = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const GridPoint &a = outline[i], &b = outline[(i + 1) % n], &c = outline[(i + 2) % n];
        if (a == b || turn(a, b, c) < 0) return false;
        reversals += (a < b) != (b < c);
    }
    return reversals == 2;
}

// Whether a value at each corner is a linear function over the plane, up to `tolerance`.
template <typename Value>
bool is_linear(const std::vector<GridPoint>& at, double tolerance, const Value& value) {
    // The plane through the three corners that span most.
    const std::size_t n = at.size();
    std::size_t b = 1, c = 2;
    const auto span = [&](std::size_t i, std::size_t j) { return std::abs(turn(at[0], at[i], at[j])); };
    for (std::size_t i = 1; i < n; ++i)
        if (span(1, i) > span(1, c)) c = i;
    for (std::size_t i = 1; i < n; ++i)
        if (span(i, c) > span(b, c)) b = i;
    const auto whole = static_cast<double>(turn(at[0], at[b], at[c]));
    if (whole == 0.0) return false;
    for (std::size_t i = 1; i < n; ++i) {
        const double along_b = static_cast<double>(turn(at[0], at[i], at[c])) / whole;
        const double along_c = static_cast<double>(turn(at[0], at[b], at[i])) / whole;
        const double expected = value(0) + along_b * (value(b) - value(0)) + along_c * (value(c) - value(0));
        if (!(std::abs(value(i) - expected) <= tolerance)) return false;
    }
    return true;
}

bool is_flat(const View& view, const Polygon& polygon) {
    if (!is_linear(view.grid, 4.0 * view.rounding, [&](std::size_t i) { return view.offset[i].dot(view.normal); }))
        return false;
    if (polygon.uv.empty()) return true;
    float largest = 0.0f;
    for (const Vec2f& uv : polygon.uv) largest = std::max({largest, std::abs(uv.x), std::abs(uv.y)});
    const double tolerance = 8.0 * float_step * static_cast<double>(largest);
    for (int axis = 0; axis < 2; ++axis)
        if (!is_linear(view.grid, tolerance,
                       [&](std::size_t i) { return static_cast<double>(polygon.uv[view.corner[i]][axis]); }))
            return false;
    return true;
}

// A fan around one of the view's corners.
void fan(const View& view, std::size_t around, Triangulation& result) {
    const std::size_t n = view.size();
    for (std::size_t i = 1; i + 1 < n; ++i)
        result.triangles.push_back(
            {view.corner[around], view.corner[(around + i) % n], view.corner[(around + i + 1) % n]});
}

std::size_t middle_of_fan(const View& view, const Polygon& polygon) {
    if (is_flat(view, polygon))
        return static_cast<std::size_t>(std::min_element(view.corner.begin(), view.corner.end()) - view.corner.begin());
    if (view.size() != 4) return 0;
    const auto length = [&](std::size_t i) { return (view.offset[i] - view.offset[i + 2]).length2(); };
    return length(1) < length(0) ? 1 : 0;
}

void sweep(const View& view, Triangulation& result) {
    const double rounding = 1.0 + view.rounding / view.cell;  // in cells; the grid's own rounding is below 1
    const Sweep swept = sweep_polygon(view.grid, 2.0 * rounding);
    if (swept.crossing) {
        const auto name = [&](std::uint32_t from) {
            return fmt::format("from corner {} to {}", view.corner[from] + 1,
                               view.corner[(from + 1) % view.size()] + 1);
        };
        const auto [a, b] = std::minmax(swept.crossing->first, swept.crossing->second);
        result.fault = fmt::format("crosses itself: its edge {} meets the one {}", name(a), name(b));
        return;
    }
    if (swept.overlap > 4.0 * rounding * view.perimeter / view.cell) {
        result.fault = "covers a part of itself twice, or backward";
        return;
    }
    for (const Triple& triangle : swept.triangles)
        result.triangles.push_back({view.corner[triangle[0]], view.corner[triangle[1]], view.corner[triangle[2]]});
}

}  // namespace

Triangulation triangulate(const Polygon& polygon) {
    Triangulation result;
    if (polygon.positions.size() == 3) {
        result.triangles.push_back({0, 1, 2});
        return result;
    }
    View view;
    order_corners(polygon, view);
    if (view.size() < 3) return result;
    find_normal(view);
    if (view.normal == Vec3d(0, 0, 0)) return result;
    project(view);
    if (is_convex(view.grid))
        fan(view, middle_of_fan(view, polygon), result);
    else
        sweep(view, result);
    return result;
}

}  // namespace shadowbench::scene
