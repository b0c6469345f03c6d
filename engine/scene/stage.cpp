#include "scene/stage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace shadowbench::scene {
namespace {

// Everything is placed with y up. With z up, y becomes z, z becomes x and x becomes y, which keeps the frame
// right-handed.
Vec3d to_world(const Vec3d& p, UpAxis up) {
    return up == UpAxis::y ? p : Vec3d(p.z, p.x, p.y);
}
Vec3d from_world(const Vec3d& p, UpAxis up) {
    return up == UpAxis::y ? p : Vec3d(p.y, p.z, p.x);
}

// Rounds to a multiple of a power of ten: a thousandth of `size`, or less.
double on_grid(double value, double size) {
    const double digits = 3.0 - std::floor(std::log10(size));
    const double scale = std::pow(10.0, std::abs(digits));
    const double rounded = digits >= 0.0 ? std::round(value * scale) / scale : std::round(value / scale) * scale;
    return rounded + 0.0;  // -0 becomes 0
}
Vec3d on_grid(const Vec3d& point, double size) {
    return {on_grid(point.x, size), on_grid(point.y, size), on_grid(point.z, size)};
}

constexpr double gap = 0.02;         // between the box and the ground, of the diagonal
constexpr double ground_size = 4.0;  // the side of the ground, of the diagonal of the box and its shadow
constexpr double margin = 1.1;       // of what the camera sees, to each side; it covers the rounding
const Vec3d light_direction(-0.5, -1.0, 0.35);
const Vec3d towards_camera(0.5, 0.45, 0.8);  // the shadow falls before the box, on its other side

// The corners of the box and of its shadow on the ground.
std::vector<Vec3d> to_be_seen(const Box3d& box, double ground) {
    std::vector<Vec3d> points;
    for (int i = 0; i < 8; ++i) {
        const Vec3d corner((i & 1 ? box.max : box.min).x, (i & 2 ? box.max : box.min).y, (i & 4 ? box.max : box.min).z);
        points.push_back(corner);
        points.push_back(corner + light_direction * (corner.y - ground));
    }
    return points;
}

// The nearest place from which a camera that looks along `forward` sees all points, and those of an axis in the middle:
// for each step away from it, `across` to the right and left and `up` upwards and downwards.
Vec3d nearest_view(const std::vector<Vec3d>& points, const Vec3d& forward, double across, double up) {
    const Vec3d right = forward.cross(Vec3d(0, 1, 0)).normalized(), upwards = right.cross(forward);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double depth = infinity;
    Vec3d place(0, 0, 0);
    for (const auto& [axis, slope] : {std::pair(right, across), std::pair(upwards, up)}) {
        double least = infinity, most = -infinity;
        for (const Vec3d& point : points) {
            least = std::min(least, point.dot(axis) + slope * point.dot(forward));
            most = std::max(most, point.dot(axis) - slope * point.dot(forward));
        }
        depth = std::min(depth, (least - most) / (2.0 * slope));
        place += axis * (0.5 * (least + most));
    }
    return place + forward * depth;
}

}  // namespace

Stage stage_around(const Box3d& world_box, UpAxis up) {
    Box3d box;
    box.extendBy(from_world(world_box.min, up));
    box.extendBy(from_world(world_box.max, up));
    const double size = box.size().length();
    const double ground = box.min.y - gap * size;
    const std::vector<Vec3d> points = to_be_seen(box, ground);
    Box3d seen;
    for (const Vec3d& point : points) seen.extendBy(point);
    const Vec3d middle = seen.center();
    const double side = ground_size * seen.size().length();
    const auto placed = [&](const Vec3d& point) { return on_grid(to_world(point, up), size); };

    Stage stage;
    stage.ground_corner = placed(Vec3d(middle.x - 0.5 * side, ground, middle.z - 0.5 * side));
    stage.ground_u = placed(Vec3d(0, 0, side));
    stage.ground_v = placed(Vec3d(side, 0, 0));
    stage.light = to_world(light_direction, up);
    const Vec3d forward = -towards_camera.normalized();
    const double slope = std::tan(0.5 * stage.camera.fov * std::numbers::pi / 180.0) / margin;
    const Vec3d position = nearest_view(points, forward, picture_aspect * slope, slope);
    stage.camera.position = placed(position);
    stage.camera.target = placed(position + forward * (middle - position).dot(forward));
    stage.camera.up = to_world(Vec3d(0, 1, 0), up);
    stage.bias = to_digits(1e-3 * size, 1);
    return stage;
}

double densest_column(const GridVolume& volume) {
    const auto columns = static_cast<std::size_t>(volume.size.x), rows = static_cast<std::size_t>(volume.size.y),
               slices = static_cast<std::size_t>(volume.size.z);
    Vec3d most(0, 0, 0);  // sums of densities
    std::vector<double> along(columns);
    const auto add_row = [&](std::size_t y, std::size_t z) {
        const float* density = volume.density.data() + (z * rows + y) * columns;
        double sum = 0.0;
        for (std::size_t x = 0; x < columns; ++x) {
            along[x] += density[x];
            sum += density[x];
        }
        return sum;
    };
    const auto take_most = [&](double& largest) {
        largest = std::max(largest, *std::max_element(along.begin(), along.end()));
        std::fill(along.begin(), along.end(), 0.0);
    };
    for (std::size_t z = 0; z < slices; ++z) {
        for (std::size_t y = 0; y < rows; ++y) most.x = std::max(most.x, add_row(y, z));
        take_most(most.y);
    }
    for (std::size_t y = 0; y < rows; ++y) {
        for (std::size_t z = 0; z < slices; ++z) add_row(y, z);
        take_most(most.z);
    }
    const Vec3d extent = volume.upper - volume.lower;
    return std::min(
        {most.x * extent.x / volume.size.x, most.y * extent.y / volume.size.y, most.z * extent.z / volume.size.z});
}

double to_digits(double value, int digits) {
    if (value == 0.0) return 0.0;
    const double exponent = digits - 1 - std::floor(std::log10(std::abs(value)));
    const double scale = std::pow(10.0, std::abs(exponent));
    return exponent >= 0.0 ? std::round(value * scale) / scale : std::round(value / scale) * scale;
}

}  // namespace shadowbench::scene
