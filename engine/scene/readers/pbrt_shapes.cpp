#include "scene/readers/pbrt_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "scene/limits.h"

namespace shadowbench::scene {
namespace {

void check_in_range(const Vec3d& point, const PbrtStatement& statement) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(point[axis]) <= max_coordinate))
            statement.fail(fmt::format("a point lies at {}, beyond {}", point[axis], max_coordinate));
}

std::vector<Vec3d> points_of(const PbrtStatement& shape) {
    const PbrtParameter* const given = shape.find("P");
    if (!given || given->numbers.empty() || given->numbers.size() % 3 != 0)
        shape.fail("the shape needs \"P\", three numbers for each of its points");
    std::vector<Vec3d> points;
    points.reserve(given->numbers.size() / 3);
    for (std::size_t i = 0; i < given->numbers.size(); i += 3) {
        points.emplace_back(given->numbers[i], given->numbers[i + 1], given->numbers[i + 2]);
        check_in_range(points.back(), shape);
    }
    return points;
}

StrandPoint between(const StrandPoint& a, const StrandPoint& b, double share) {
    return {a.at + (b.at - a.at) * share, a.radius + (b.radius - a.radius) * share};
}

// The same curve as one of degree 3.
CubicCurve elevated(const StrandPoint& a, const StrandPoint& b, const StrandPoint& c) {
    return {a, between(a, b, 2.0 / 3.0), between(b, c, 1.0 / 3.0), c};
}

// The piece that begins at this control point.
CubicCurve piece_of(const std::vector<Vec3d>& points, std::size_t at, bool quadratic, bool spline) {
    const auto control = [&](std::size_t i) { return StrandPoint{points[at + i], 0.0}; };
    if (!quadratic) {
        const CubicCurve cubic{control(0), control(1), control(2), control(3)};
        return spline ? bezier_of_spline(cubic) : cubic;
    }
    if (!spline) return elevated(control(0), control(1), control(2));
    return elevated(between(control(0), control(1), 0.5), control(1), between(control(1), control(2), 0.5));
}

std::size_t count_pieces(const PbrtStatement& shape, std::size_t points, std::size_t degree, bool spline) {
    if (points <= degree) shape.fail(fmt::format("{} points; a curve of degree {} needs more", points, degree));
    if (spline) return points - degree;
    if ((points - 1) % degree != 0)
        shape.fail(
            fmt::format("{} points; pieces of degree {} need a multiple of {}, and one more", points, degree, degree));
    return (points - 1) / degree;
}

double width_of(const PbrtStatement& shape, const char* name) {
    const double width = shape.number(name, shape.number("width", 1.0));
    if (!(width >= 0.0 && width <= max_coordinate))
        shape.fail(fmt::format("a width of {}, where 0 to {} are read", width, max_coordinate));
    return width;
}

// On which side of the box a point lies along each axis; -1: on neither.
std::array<int, 3> sides_of(const Box3d& box, const Vec3d& point) {
    std::array<int, 3> sides{};
    for (int axis = 0; axis < 3; ++axis) {
        const double rounding = 1e-5 * (box.max[axis] - box.min[axis]);
        const bool low = std::abs(point[axis] - box.min[axis]) <= rounding;
        const bool high = std::abs(point[axis] - box.max[axis]) <= rounding;
        sides[static_cast<std::size_t>(axis)] = low ? 0 : high ? 1 : -1;
    }
    return sides;
}

// Half a face of a box: which face, and the corner of it that the triangle leaves out.
struct HalfFace {
    std::size_t face = 0;
    unsigned missing = 0;
};

std::optional<HalfFace> half_face(const std::array<std::array<int, 3>, 3>& corners) {
    for (const auto& corner : corners)
        if (std::find(corner.begin(), corner.end(), -1) != corner.end()) return std::nullopt;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (corners[0][axis] != corners[1][axis] || corners[1][axis] != corners[2][axis]) continue;
        unsigned seen = 0;
        for (const auto& corner : corners)
            seen |= 1u << static_cast<unsigned>(corner[(axis + 1) % 3] + 2 * corner[(axis + 2) % 3]);
        for (unsigned missing = 0; missing < 4; ++missing)
            if (seen == (0xfu & ~(1u << missing)))
                return HalfFace{2 * axis + static_cast<std::size_t>(corners[0][axis]), missing};
    }
    return std::nullopt;
}

}  // namespace

Mesh pbrt_triangles(const PbrtStatement& shape) {
    Mesh mesh;
    for (const Vec3d& point : points_of(shape)) mesh.positions.emplace_back(point);
    const PbrtParameter* const given = shape.find("indices");
    const std::vector<double> indices = given ? given->numbers : std::vector<double>{0, 1, 2};
    if (indices.size() % 3 != 0) shape.fail(fmt::format("{} indices are no triangles of 3", indices.size()));
    if (!given && mesh.positions.size() != 3) shape.fail("\"indices\" is missing: only three points need none");
    const auto count = static_cast<double>(mesh.positions.size());
    for (const double index : indices)
        if (!(index >= 0.0 && index < count) || index != std::floor(index))
            shape.fail(fmt::format("a triangle names point {}, but there are {}", index, mesh.positions.size()));
    mesh.triangles.reserve(indices.size() / 3);
    for (std::size_t i = 0; i < indices.size(); i += 3)
        mesh.triangles.emplace_back(Vec3d(indices[i], indices[i + 1], indices[i + 2]));
    return mesh;
}

void add_placed(const Mesh& mesh, const Matrix& place, const PbrtStatement& statement, Mesh& to) {
    const auto offset = static_cast<int>(to.positions.size());
    for (const Vec3f& position : mesh.positions) {
        const Vec3d placed = transform_point(place, Vec3d(position));
        check_in_range(placed, statement);
        to.positions.emplace_back(placed);
    }
    for (const Vec3i& triangle : mesh.triangles) to.triangles.push_back(triangle + Vec3i(offset));
}

void add_placed(const Hair& hair, const Matrix& place, const PbrtStatement& statement, Strands& to) {
    const double scale = mean_scale(place);
    Hair placed = hair;
    for (Vec3f& point : placed.points) {
        const Vec3d at = transform_point(place, Vec3d(point));
        check_in_range(at, statement);
        point = Vec3f(at);
    }
    for (float& radius : placed.radii) {
        const double grown = static_cast<double>(radius) * scale;
        if (!(grown <= max_coordinate)) statement.fail(fmt::format("a width grows beyond {}", max_coordinate));
        radius = static_cast<float>(grown);
    }
    to.append(placed);
}

void add_pbrt_curve(const PbrtStatement& shape, const Matrix& place, std::uint64_t most_points, Strands& to) {
    const double degree = shape.number("degree", 3.0);
    if (degree != 2.0 && degree != 3.0) shape.fail(fmt::format("a curve of degree {}; 2 and 3 are read", degree));
    const std::string basis = shape.text("basis", "bezier");
    if (basis != "bezier" && basis != "bspline")
        shape.fail(fmt::format("a curve of the basis \"{}\"; bezier and bspline are read", basis.substr(0, 40)));
    const bool spline = basis == "bspline";
    const auto step = static_cast<std::size_t>(degree);
    std::vector<Vec3d> points = points_of(shape);
    const std::size_t pieces = count_pieces(shape, points.size(), step, spline);
    const double scale = 0.5 * mean_scale(place);
    const double first = scale * width_of(shape, "width0"), last = scale * width_of(shape, "width1");
    if (!(std::max(first, last) <= max_coordinate)) shape.fail(fmt::format("a width grows beyond {}", max_coordinate));
    for (Vec3d& point : points) {
        point = transform_point(place, point);
        check_in_range(point, shape);
    }
    for (std::size_t piece = 0; piece < pieces; ++piece) {
        CubicCurve curve = piece_of(points, spline ? piece : piece * step, step == 2, spline);
        // The width changes evenly along all pieces.
        for (std::size_t i = 0; i < curve.size(); ++i) {
            const double u = (static_cast<double>(piece) + static_cast<double>(i) / 3.0) / static_cast<double>(pieces);
            curve[i].radius = first + (last - first) * u;
        }
        if (piece == 0 && !to.ends_at(curve[0])) to.begin(curve[0]);
        to.curve_to(curve);
        if (to.points() > most_points) shape.fail(fmt::format("over {} points of hair", most_points));
    }
}

std::optional<Box3d> box_of(const Mesh& mesh) {
    if (mesh.triangles.size() != box_triangles) return std::nullopt;
    Box3d box;
    for (const Vec3f& position : mesh.positions) box.extendBy(Vec3d(position));
    for (int axis = 0; axis < 3; ++axis)
        if (!(box.max[axis] - box.min[axis] >= min_length)) return std::nullopt;
    std::array<std::vector<unsigned>, 6> missing;
    for (const Vec3i& triangle : mesh.triangles) {
        std::array<std::array<int, 3>, 3> corners{};
        for (int i = 0; i < 3; ++i)
            corners[static_cast<std::size_t>(i)] =
                sides_of(box, Vec3d(mesh.positions[static_cast<std::size_t>(triangle[i])]));
        const std::optional<HalfFace> half = half_face(corners);
        if (!half) return std::nullopt;
        missing[half->face].push_back(half->missing);
    }
    // The two halves of a face leave out opposite corners.
    for (const std::vector<unsigned>& face : missing)
        if (face.size() != 2 || (face[0] ^ face[1]) != 3u) return std::nullopt;
    return box;
}

}  // namespace shadowbench::scene
