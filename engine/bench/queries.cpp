#include "bench/queries.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "base/random.h"
#include "scene/cube_face.h"

namespace shadowbench::bench {
namespace {

using base::Vec3d;
using techniques::Footprint;
using techniques::Query;

constexpr double behind = 0.05;  // of the depth range: how far probes reach behind the casters

std::optional<Query> query_if_seen(const Vec3d& place, double width, const rays::LightView& view) {
    const Query query{static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(place.z),
                      static_cast<float>(width)};
    const bool seen = query.x >= 0.0f && query.y >= 0.0f && query.x < static_cast<float>(view.resolution.x) &&
                      query.y < static_cast<float>(view.resolution.y) && place.z > view.z_near &&
                      std::isfinite(query.z);
    return seen ? std::optional(query) : std::nullopt;
}

void append(const std::optional<Query>& query, QuerySet& set) {
    if (query)
        set.queries.push_back(*query);
    else
        ++set.dropped;
}

// Map pixels across a footprint at planar depth z, for units other than receiver pixels.
double width_at(double z, const scene::FilterWidth& width, const rays::LightView& view) {
    switch (width.unit) {
        case scene::WidthUnit::share:
            return width.value * view.resolution.x;
        case scene::WidthUnit::length:
            return width.value / ((view.perspective ? z : 1.0) * view.pixel.x);
        default:
            return width.value;
    }
}

// The side of a square as large as the parallelogram.
double side_of(const Footprint& f) {
    if (!f.known()) return std::numeric_limits<double>::infinity();
    return std::sqrt(std::abs(static_cast<double>(f.ux) * f.vy - static_cast<double>(f.uy) * f.vx));
}

// Where a point of a surface is looked up: moved along its normal, which is turned towards the light.
Vec3d off_surface(const CameraPoint& point, double normal_bias, const rays::LightView& view) {
    if (!(normal_bias > 0.0)) return point.position;
    const double z = (point.position - view.origin).dot(view.forward);
    const Vec3d to_light = view.perspective ? (view.origin - point.position).normalized() : -view.forward;
    const double pixel = std::max(view.pixel.x, view.pixel.y) * (view.perspective ? std::max(z, 0.0) : 1.0);
    const double side = point.normal.dot(to_light) < 0.0 ? -1.0 : 1.0;
    return point.position + point.normal * (side * normal_bias * pixel * point.normal.cross(to_light).length());
}

// How much the depth of a plane with this normal changes over a map pixel, in the direction of x or of y, whichever is
// more: rays at slope (x, y) meet the plane through a point of depth z at z (n . p) / (n . (x, y, 1)).
double depth_slope(const Vec3d& normal, const Vec3d& place, const rays::LightView& view) {
    if (normal == Vec3d(0.0)) return 0.0;
    const double nx = normal.dot(view.right), ny = normal.dot(view.up), nz = normal.dot(view.forward);
    const double x = view.lower.x + place.x * view.pixel.x, y = view.lower.y + place.y * view.pixel.y;
    const double across = std::abs(view.perspective ? nx * x + ny * y + nz : nz);
    const double most = std::max(std::abs(nx) * view.pixel.x, std::abs(ny) * view.pixel.y);
    return most == 0.0 ? 0.0 : (view.perspective ? place.z : 1.0) * most / across;
}

// For a face of a point light that no receiver is in: which faces have some.
std::string remedy(const scene::Receivers& receivers, const scene::Light& light, std::span<const CameraPoint> seen) {
    if (!light.face) return "";
    std::array<bool, scene::cube_faces.size()> has{};
    const auto note = [&](const Vec3d& point) {
        has[static_cast<std::size_t>(scene::cube_face(point - light.position))] = true;
    };
    for (const CameraPoint& point : seen) note(point.position);
    for (const Vec3d& point : receivers.points) note(point);
    if (has[static_cast<std::size_t>(*light.face)]) return "; some are in its face, but nearer than its \"near\"";
    std::string faces;
    for (std::size_t i = 0; i < has.size(); ++i)
        if (has[i]) faces += fmt::format("{}\"{}\"", faces.empty() ? "" : ", ", scene::cube_faces[i]);
    return fmt::format("; give its light \"faces\": [{}]", faces);
}

// Relative to the size of the map. The pixels must also keep their shape, since a query has one width.
constexpr double frame_rounding = 1e-9;

void check_same_frame(const rays::LightView& a, const rays::LightView& b) {
    const auto differ = [](double first, double second, double size) {
        return !(std::abs(first - second) <= frame_rounding * size);
    };
    const double width = a.pixel.x * a.resolution.x, height = a.pixel.y * a.resolution.y;
    if (a.perspective == b.perspective && !differ(a.lower.x, b.lower.x, width) &&
        !differ(a.lower.y, b.lower.y, height) && !differ(width, b.pixel.x * b.resolution.x, width) &&
        !differ(height, b.pixel.y * b.resolution.y, height) &&
        !differ(a.pixel.x / b.pixel.x, a.pixel.y / b.pixel.y, a.pixel.x / b.pixel.x) && a.z_min == b.z_min &&
        a.z_max == b.z_max)
        return;
    throw base::Error(
        base::ErrorCode::internal, "light",
        fmt::format("maps of {} x {} and of {} x {} pixels do not frame the same part of the light's plane",
                    a.resolution.x, a.resolution.y, b.resolution.x, b.resolution.y));
}

}  // namespace

Footprint footprint_of(const CameraPoint& point, const rays::LightView& view) {
    const Vec3d place = rays::to_light(view, point.position);
    const auto in_map = [&](const Vec3d& edge, float& x, float& y) {
        double dx = edge.dot(view.right), dy = edge.dot(view.up);
        if (view.perspective) {  // of the slope (x / z, y / z)
            const double dz = edge.dot(view.forward);
            dx = (dx - (view.lower.x + place.x * view.pixel.x) * dz) / place.z;
            dy = (dy - (view.lower.y + place.y * view.pixel.y) * dz) / place.z;
        }
        x = static_cast<float>(dx / view.pixel.x);
        y = static_cast<float>(dy / view.pixel.y);
    };
    Footprint f;
    in_map(point.across, f.ux, f.uy);
    in_map(point.down, f.vx, f.vy);
    // Unbounded edges of a surface seen edge-on: treated as unknown.
    const bool finite = std::isfinite(f.ux) && std::isfinite(f.uy) && std::isfinite(f.vx) && std::isfinite(f.vy);
    return finite ? f : Footprint{};
}

std::optional<Query> query_of_point(const CameraPoint& point, const scene::Receivers& receivers,
                                    const rays::LightView& view, const std::optional<scene::FilterWidth>& softness) {
    const scene::FilterWidth filter = softness.value_or(receivers.filter_width);
    // The face is that of the surface itself, so that all biases ask one face.
    if (view.face >= 0 && scene::cube_face(point.position - view.origin) != view.face) return std::nullopt;
    Vec3d place = rays::to_light(view, off_surface(point, receivers.normal_bias, view));
    if (view.perspective && !(place.z > view.z_near)) return std::nullopt;
    const double width = filter.unit == scene::WidthUnit::receiver_pixels
                             ? filter.value * side_of(footprint_of(point, view))
                             : width_at(place.z, filter, view);
    if (receivers.slope_bias > 0.0) {
        const double first = std::max(view.z_min, std::nextafter(view.z_near, view.z_max));
        place.z =
            std::max(place.z - receivers.slope_bias * depth_slope(point.normal, place, view), std::min(place.z, first));
    }
    if (receivers.bias > 0.0) place.z -= receivers.bias / rays::length_per_depth(view, place.x, place.y);
    return query_if_seen(place, width, view);
}

QuerySet queries_of_points(std::span<const CameraPoint> points, const scene::Receivers& receivers,
                           const rays::LightView& view, const std::optional<scene::FilterWidth>& softness) {
    QuerySet set;
    for (const CameraPoint& point : points) {
        const std::optional<Query> query = query_of_point(point, receivers, view, softness);
        append(query, set);
        if (query) set.footprints.push_back(footprint_of(point, view));
    }
    return set;
}

QuerySet point_queries(const scene::Receivers& receivers, const rays::LightView& view,
                       const std::optional<scene::FilterWidth>& softness) {
    QuerySet set;
    for (const Vec3d& point : receivers.points) append(query_of_point({point}, receivers, view, softness), set);
    return set;
}

QuerySet probe_queries(const scene::Receivers& receivers, const rays::LightView& view,
                       const std::optional<scene::FilterWidth>& softness) {
    QuerySet set;
    const scene::FilterWidth filter = softness.value_or(receivers.filter_width);
    const double range = view.z_max - view.z_min;
    base::Vec2d low(0.0, 0.0), high(view.resolution);
    if (view.face >= 0) {  // without the border
        low = (base::Vec2d(-1.0, -1.0) - view.lower) / view.pixel;
        high = (base::Vec2d(1.0, 1.0) - view.lower) / view.pixel;
    }
    for (int i = 0; i < receivers.count; ++i) {
        base::Random random(base::hash(receivers.seed, static_cast<std::uint64_t>(i)));
        Vec3d place;
        place.x = random.uniform(low.x, high.x);
        place.y = random.uniform(low.y, high.y);
        place.z = random.uniform(view.z_min, view.z_max + behind * range);
        append(query_if_seen(place, width_at(place.z, filter, view), view), set);
    }
    return set;
}

QuerySet scenario_queries(const scene::Scenario& scenario, const scene::Light& light, std::span<const CameraPoint> seen,
                          const rays::LightView& view) {
    const scene::Receivers& receivers = scenario.receivers;
    QuerySet set = receivers.camera            ? queries_of_points(seen, receivers, view, light.softness)
                   : !receivers.points.empty() ? point_queries(receivers, view, light.softness)
                                               : probe_queries(receivers, view, light.softness);
    if (!set.queries.empty()) return set;
    throw base::Error(base::ErrorCode::bad_input, "/receivers",
                      set.dropped == 0 ? "there are no receivers: the camera sees no surface and no medium"
                                       : fmt::format("none of the {} receivers is inside the map of light \"{}\"{}",
                                                     set.dropped, light.name, remedy(receivers, light, seen)));
}

CutLookups cut_at_seams(std::span<const Query> queries, const rays::LightView& view) {
    CutLookups cut;
    for (const Query& q : queries) {
        const double half = 0.5 * static_cast<double>(q.width), x = static_cast<double>(q.x),
                     y = static_cast<double>(q.y);
        const bool inside =
            x - half >= 0.0 && y - half >= 0.0 && x + half <= view.resolution.x && y + half <= view.resolution.y;
        if (inside || !std::isfinite(half)) continue;
        ++cut.count;
        // The face reaches from slope -1 to 1.
        const double slope = std::max(std::abs(view.lower.x + x * view.pixel.x) + half * view.pixel.x,
                                      std::abs(view.lower.y + y * view.pixel.y) + half * view.pixel.y);
        cut.border = std::max(cut.border, slope - 1.0);
    }
    return cut;
}

QuerySet judged_queries(const scene::Scenario& scenario, const QuerySet& set) {
    const scene::Reference& reference = scenario.reference;
    return pick(set.asked(),
                choose_judged(set.queries.size(), static_cast<std::size_t>(reference.queries), reference.seed));
}

QuerySet rescaled(const Asked& asked, const rays::LightView& from, const rays::LightView& to) {
    check_same_frame(from, to);
    const float x = static_cast<float>(from.pixel.x / to.pixel.x), y = static_cast<float>(from.pixel.y / to.pixel.y);
    // A position in the map stays in it, whatever the rounding.
    const float right = std::nextafter(static_cast<float>(to.resolution.x), 0.0f),
                top = std::nextafter(static_cast<float>(to.resolution.y), 0.0f);
    QuerySet set;
    set.queries.reserve(asked.queries.size());
    for (const Query& q : asked.queries)
        set.queries.push_back({std::min(q.x * x, right), std::min(q.y * y, top), q.z, q.width * x});
    for (const Footprint& f : asked.footprints) set.footprints.push_back({f.ux * x, f.uy * y, f.vx * x, f.vy * y});
    return set;
}

std::vector<std::size_t> choose_judged(std::size_t total, std::size_t count, std::uint64_t seed) {
    count = std::min(count, total);
    std::vector<std::size_t> chosen(count);
    for (std::size_t i = 0; i < count; ++i) {
        // Stretch i is [i * total / count, (i + 1) * total / count): never empty, so no query is chosen twice.
        const std::size_t first = i * total / count, last = (i + 1) * total / count;
        chosen[i] = first + base::Random(base::hash(seed, i)).below(last - first);
    }
    return chosen;
}

QuerySet pick(const Asked& asked, std::span<const std::size_t> indices) {
    QuerySet set;
    for (const std::size_t i : indices) {
        set.queries.push_back(asked.queries[i]);
        if (!asked.footprints.empty()) set.footprints.push_back(asked.footprints[i]);
    }
    return set;
}

}  // namespace shadowbench::bench
