#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/json_read.h"
#include "scene/limits.h"
#include "scene/load.h"
#include "scene/turn.h"

namespace shadowbench::scene {
namespace {

using base::Matrix4d;

// The images of the axes, and of the origin.
Matrix4d affine(const Vec3d& x, const Vec3d& y, const Vec3d& z, const Vec3d& origin) {
    return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, origin.x, origin.y, origin.z, 1};
}

Vec3d axis_of(const Matrix4d& matrix, int i) {
    return {matrix[i][0], matrix[i][1], matrix[i][2]};
}

Matrix4d rotation(const Vec3d& degrees) {
    const auto about = [&](int axis) {
        const Turn by = turn(degrees[axis] / 360.0);
        std::array<Vec3d, 3> image{Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)};
        const int next = (axis + 1) % 3, last = (axis + 2) % 3;
        image[static_cast<std::size_t>(next)][next] = image[static_cast<std::size_t>(last)][last] = by.cosine;
        image[static_cast<std::size_t>(next)][last] = by.sine;
        image[static_cast<std::size_t>(last)][next] = -by.sine;
        return affine(image[0], image[1], image[2], Vec3d(0.0));
    };
    return about(0) * about(1) * about(2);
}

Vec3d scale_of(const json& from, const std::string& where) {
    Vec3d scale(1, 1, 1);
    const auto given = from.find("scale");
    if (given == from.end()) return scale;
    if (given->is_number()) return Vec3d(given->get<double>());
    read(from, "scale", scale);
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(scale[axis]) >= min_length))
            refuse(fmt::format("{}/scale/{}", where, axis),
                   fmt::format("a factor of {} flattens the object: it must be at least {} or at most -{}", scale[axis],
                               min_length, min_length));
    return scale;
}

// The matrix may lose a few digits when it is inverted, but not more.
void check_matrix(const Matrix4d& matrix, const std::string& where) {
    std::array<Vec3d, 3> axes;
    for (int i = 0; i < 3; ++i) {
        const Vec3d axis = axis_of(matrix, i);
        if (!(axis.length() >= min_length))
            refuse(where, fmt::format("column {} is shorter than {}, which flattens the object", i, min_length));
        axes[static_cast<std::size_t>(i)] = axis.normalized();
    }
    constexpr double flattest = 1e-6;
    if (!(std::abs(axes[0].dot(axes[1].cross(axes[2]))) >= flattest))
        refuse(where, "the first three columns lie in one plane, which flattens the object");
}

Matrix4d given_matrix(const json& from, const std::string& where) {
    for (const char* key : {"scale", "rotate", "translate"})
        if (from.contains(key))
            refuse(fmt::format("{}/{}", where, key), "\"matrix\" holds this already; remove one of the two");
    const json& given = from["matrix"];
    const auto column = [&](std::size_t i) {
        return Vec3d(given[0][i].get<double>(), given[1][i].get<double>(), given[2][i].get<double>());
    };
    const Matrix4d matrix = affine(column(0), column(1), column(2), column(3));
    check_matrix(matrix, where + "/matrix");
    return matrix;
}

// A similarity changes no angle: it scales all directions alike.
bool is_similarity(const Matrix4d& matrix) {
    constexpr double rounding = 1e-6;  // of matrices that were written as floats
    const Vec3d x = axis_of(matrix, 0), y = axis_of(matrix, 1), z = axis_of(matrix, 2);
    const double square = x.length2();
    return std::abs(y.length2() - square) <= 2.0 * rounding * square &&
           std::abs(z.length2() - square) <= 2.0 * rounding * square && std::abs(x.dot(y)) <= rounding * square &&
           std::abs(y.dot(z)) <= rounding * square && std::abs(z.dot(x)) <= rounding * square;
}

double growth(const Matrix4d& matrix) {
    const Vec3d x = axis_of(matrix, 0), y = axis_of(matrix, 1), z = axis_of(matrix, 2);
    return is_similarity(matrix) ? x.length() : std::cbrt(std::abs(x.dot(y.cross(z))));
}

struct Mover {
    const Matrix4d& matrix;
    const std::string& where;

    void move(std::vector<Vec3f>& points) const {
        for (Vec3f& point : points) {
            const Vec3d moved = base::map_point(matrix, Vec3d(point));
            if (!(std::max({std::abs(moved.x), std::abs(moved.y), std::abs(moved.z)}) <= max_coordinate))
                refuse(where,
                       fmt::format("its scale, rotate, translate or matrix moves a point beyond {}", max_coordinate));
            point = Vec3f(moved);
        }
    }

    void grow(std::vector<float>& radii) const {
        const double factor = growth(matrix);
        for (float& radius : radii) {
            const double grown = radius * factor;
            if (radius > 0.0f && !(grown >= min_length && grown <= max_coordinate))
                refuse(where, fmt::format("its scale or matrix makes a radius {}; it must be {} to {}", grown,
                                          min_length, max_coordinate));
            radius = static_cast<float>(grown);
        }
    }

    void operator()(Mesh& mesh) const { move(mesh.positions); }
    void operator()(Spheres& spheres) const {
        if (!is_similarity(matrix))
            refuse(where,
                   "its scale or matrix would make ellipsoids of spheres: scale all directions alike, or give a mesh");
        move(spheres.centres);
        grow(spheres.radii);
    }
    void operator()(Hair& hair) const {
        move(hair.points);
        grow(hair.radii);
        merge_equal_points(hair);
    }
    void operator()(Particles& particles) const {
        move(particles.centres);
        grow(particles.radii);
    }
    void operator()(GridVolume& volume) const {
        place(volume, matrix);
        const Box3d box = world_box(volume);
        for (int axis = 0; axis < 3; ++axis)
            if (!(box.min[axis] >= -max_coordinate && box.max[axis] <= max_coordinate) ||
                !(box.max[axis] - box.min[axis] >= min_length))
                refuse(where, fmt::format("in the world the volume runs from {} to {} along an axis; both must be at "
                                          "most {} from 0 and {} apart at least",
                                          box.min[axis], box.max[axis], max_coordinate, min_length));
    }
};

}  // namespace

std::optional<Matrix4d> load_transform(const json& from, const std::string& where) {
    Matrix4d matrix;
    if (from.value("up", "y") == "z") matrix = affine({1, 0, 0}, {0, 0, -1}, {0, 1, 0}, Vec3d(0.0));
    if (from.contains("matrix")) {
        matrix *= given_matrix(from, where);
    } else {
        const Vec3d scale = scale_of(from, where);
        Vec3d degrees(0.0), translate(0.0);
        read(from, "rotate", degrees);
        read(from, "translate", translate);
        matrix *= affine({scale.x, 0, 0}, {0, scale.y, 0}, {0, 0, scale.z}, Vec3d(0.0));
        matrix *= rotation(degrees);
        matrix *= affine({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, translate);
    }
    return matrix == Matrix4d() ? std::nullopt : std::optional(matrix);
}

void apply(const Matrix4d& transform, Object& object, const std::string& where) {
    std::visit(Mover{transform, where}, object.shape);
}

}  // namespace shadowbench::scene
