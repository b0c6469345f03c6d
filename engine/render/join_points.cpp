#include "render/join_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace shadowbench::render {
namespace {

using base::Vec3d;
using base::Vec3f;

constexpr float same_way = 0.9f;  // least cosine between the normals of points of one plane

double weight_of(const SeenPoint& point) {
    return static_cast<double>(point.coverage.x) + point.coverage.y + point.coverage.z;
}

// A point that others join. `first` stands for its plane.
struct Group {
    SeenPoint first;
    std::size_t index;  // of `first`, in the pixel
    double weight;
    Vec3d place;  // times weight
    Vec3f coverage;
};

// How much deeper than the first point of a group its others may lie.
double reach_of(const JoinSettings& settings, const SeenPoint& first) {
    const double pixel = settings.pixel * first.t;
    switch (first.kind) {
        case SeenPoint::Kind::medium:
            return 0.5 * settings.step;
        case SeenPoint::Kind::hair:
            return pixel;
        case SeenPoint::Kind::surface:
            return static_cast<double>(settings.rays_per_side) * (first.across.length() + first.down.length());
    }
    return 0.0;
}

bool same_lights(const JoinSettings& settings, const PixelPoints& pixel, std::size_t a, std::size_t b) {
    for (std::size_t l = 0; l < settings.lights; ++l) {
        const bool lit = pixel.radiance[a * settings.lights + l] != Vec3f(0.0f);
        if (lit != (pixel.radiance[b * settings.lights + l] != Vec3f(0.0f))) return false;
    }
    return true;
}

bool joins(const JoinSettings& settings, const SeenPoint& first, const SeenPoint& point) {
    if (first.kind != point.kind) return false;
    if (first.kind != SeenPoint::Kind::surface) return true;
    const double off = std::abs((point.place - first.place).dot(Vec3d(first.normal)));
    return first.normal.dot(point.normal) >= same_way && off <= settings.pixel * first.t;
}

SeenPoint joined(const JoinSettings& settings, const Group& group) {
    SeenPoint point = group.first;
    const auto whole = static_cast<float>(settings.rays_per_side);
    if (group.weight > 0.0) point.place = group.place / group.weight;
    point.across *= whole;
    point.down *= whole;
    point.coverage = group.coverage;
    return point;
}

}  // namespace

void join_points(const JoinSettings& settings, PixelPoints& pixel) {
    std::vector<std::size_t> order(pixel.points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return pixel.points[a].t < pixel.points[b].t; });
    std::vector<Group> groups;
    std::vector<std::size_t> open;  // groups that deeper points may still join
    std::vector<Vec3f> radiance;
    for (const std::size_t i : order) {
        const SeenPoint& point = pixel.points[i];
        std::erase_if(
            open, [&](std::size_t g) { return !(point.t - groups[g].first.t <= reach_of(settings, groups[g].first)); });
        const auto found = std::find_if(open.begin(), open.end(), [&](std::size_t g) {
            return joins(settings, groups[g].first, point) && same_lights(settings, pixel, groups[g].index, i);
        });
        const double weight = weight_of(point);
        const auto lights = pixel.radiance.begin() + static_cast<std::ptrdiff_t>(i * settings.lights);
        if (found == open.end()) {
            open.push_back(groups.size());
            groups.push_back({point, i, weight, point.place * weight, point.coverage});
            radiance.insert(radiance.end(), lights, lights + static_cast<std::ptrdiff_t>(settings.lights));
            continue;
        }
        Group& group = groups[*found];
        group.weight += weight;
        group.place += point.place * weight;
        group.coverage += point.coverage;
        for (std::size_t l = 0; l < settings.lights; ++l)
            radiance[*found * settings.lights + l] += lights[static_cast<std::ptrdiff_t>(l)];
    }
    pixel.points.clear();
    for (const Group& group : groups) pixel.points.push_back(joined(settings, group));
    pixel.radiance = std::move(radiance);
}

}  // namespace shadowbench::render
