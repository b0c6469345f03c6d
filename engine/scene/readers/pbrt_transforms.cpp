#include "scene/readers/pbrt_transforms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace shadowbench::scene {
namespace {

Vec3d row(const Matrix& matrix, int i) {
    return {matrix[i][0], matrix[i][1], matrix[i][2]};
}

}  // namespace

Matrix translation(const Vec3d& by) {
    Matrix matrix;
    for (int i = 0; i < 3; ++i) matrix[3][i] = by[i];
    return matrix;
}

Matrix scaling(const Vec3d& by) {
    Matrix matrix;
    for (int i = 0; i < 3; ++i) matrix[i][i] = by[i];
    return matrix;
}

// Rodrigues' formula. Quarter turns are exact.
Matrix rotation(double degrees, const Vec3d& axis) {
    const Vec3d a = axis.normalized();
    const double quarters = degrees / 90.0;
    double s = std::sin(degrees * std::numbers::pi / 180.0), c = std::cos(degrees * std::numbers::pi / 180.0);
    if (quarters == std::floor(quarters)) {
        s = std::round(s);
        c = std::round(c);
    }
    Matrix matrix;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) matrix[i][j] = a[i] * a[j] * (1.0 - c) + (i == j ? c : 0.0);
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        matrix[j][k] += s * a[i];
        matrix[k][j] -= s * a[i];
    }
    return matrix;
}

std::optional<Matrix> looking(const Vec3d& from, const Vec3d& at, const Vec3d& up) {
    const Vec3d z = (at - from).normalized(), x = up.cross(z).normalized(), y = z.cross(x);
    if (!(z.length() > 0.5) || !(x.length() > 0.5)) return std::nullopt;
    Matrix matrix;
    for (int i = 0; i < 3; ++i) {
        matrix[i][0] = x[i];
        matrix[i][1] = y[i];
        matrix[i][2] = z[i];
    }
    matrix[3][0] = -from.dot(x);
    matrix[3][1] = -from.dot(y);
    matrix[3][2] = -from.dot(z);
    return matrix;
}

bool is_affine(const Matrix& matrix) {
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            if (!std::isfinite(matrix[i][j]) || (j == 3 && matrix[i][j] != (i == 3 ? 1.0 : 0.0))) return false;
    return true;
}

Vec3d transform_point(const Matrix& matrix, const Vec3d& point) {
    return transform_direction(matrix, point) + row(matrix, 3);
}

Vec3d transform_direction(const Matrix& matrix, const Vec3d& direction) {
    return row(matrix, 0) * direction.x + row(matrix, 1) * direction.y + row(matrix, 2) * direction.z;
}

double mean_scale(const Matrix& matrix) {
    return std::cbrt(std::abs(row(matrix, 0).dot(row(matrix, 1).cross(row(matrix, 2)))));
}

bool is_uniform(const Matrix& matrix) {
    constexpr double rounding = 1e-4;
    const std::array lengths{row(matrix, 0).length(), row(matrix, 1).length(), row(matrix, 2).length()};
    const auto [least, most] = std::minmax_element(lengths.begin(), lengths.end());
    if (!(*most - *least <= rounding * *most)) return false;
    for (int i = 0; i < 3; ++i)
        if (std::abs(row(matrix, i).dot(row(matrix, (i + 1) % 3))) > rounding * *most * *most) return false;
    return *most > 0.0;
}

}  // namespace shadowbench::scene
