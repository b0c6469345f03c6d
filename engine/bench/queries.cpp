#include "bench/queries.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/random.h"
#include "rays/image_plane.h"

namespace shadowbench::bench {
namespace {

using base::Vec3d;
using techniques::Footprint;
using techniques::Query;

constexpr double behind = 0.05;  // of the depth range: how far probes reach behind what casts shadows

struct Span {
    double front, back;
};

// Where the ray is inside of any medium: disjoint, in order.
std::vector<Span> media_spans(const std::vector<rays::TracedSegment>& segments) {
    std::vector<Span> spans;
    for (const rays::TracedSegment& segment : segments) {
        if (!(segment.front < segment.back)) continue;
        if (!spans.empty() && segment.front <= spans.back().back)
            spans.back().back = std::max(spans.back().back, segment.back);
        else
            spans.push_back({segment.front, segment.back});
    }
    return spans;
}

// Appends the distances of `count` places that divide the spans into equal parts.
void spread(const std::vector<Span>& spans, int count, std::vector<double>& distances) {
    double length = 0.0;
    for (const Span& span : spans) length += span.back - span.front;
    std::size_t at = 0;
    double before = 0.0;  // length of the spans already passed
    for (int i = 0; i < count && !spans.empty(); ++i) {
        const double wanted = (i + 0.5) / count * length;
        while (at + 1 < spans.size() && before + spans[at].back - spans[at].front < wanted) {
            before += spans[at].back - spans[at].front;
            ++at;
        }
        distances.push_back(std::min(spans[at].front + (wanted - before), spans[at].back));
    }
}

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

}  // namespace

// Where the rays through the neighbouring pixels meet the plane through the point.
CameraPoint camera_point(const rays::ImagePlane& plane, const Vec3d& through, const Vec3d& point, const Vec3d& normal) {
    const double scale = (point - plane.origin).length() / through.length();
    const auto edge = [&](const Vec3d& step) {
        return (step - through * (normal.dot(step) / normal.dot(through))) * scale;
    };
    return {point, edge(plane.across), edge(plane.down)};
}

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
    // Of a surface seen edge-on: as good as not known.
    const bool finite = std::isfinite(f.ux) && std::isfinite(f.uy) && std::isfinite(f.vx) && std::isfinite(f.vy);
    return finite ? f : Footprint{};
}

std::vector<CameraPoint> camera_points(const scene::Receivers& receivers, const rays::Tracer& tracer) {
    const base::Vec2i resolution = receivers.resolution;
    const rays::ImagePlane plane = rays::make_image_plane(*receivers.camera, resolution);
    std::vector<std::vector<CameraPoint>> rows(static_cast<std::size_t>(resolution.y));
    base::parallel_for(rows.size(), [&](std::size_t row) {
        std::vector<rays::TracedSegment> segments;
        std::vector<double> distances;
        for (int x = 0; x < resolution.x; ++x) {
            const Vec3d through = plane.through(x + 0.5, static_cast<double>(row) + 0.5);
            const Vec3d direction = through.normalized();
            rays::SurfaceHit hit;
            const bool surface = tracer.nearest(plane.origin, direction, hit, scene::mid_shutter);
            const double end = surface ? hit.t : std::numeric_limits<double>::infinity();
            distances.clear();
            if (receivers.media_lookups > 0) {
                tracer.all_segments(plane.origin, direction, 0.0, end, segments, scene::mid_shutter);
                spread(media_spans(segments), receivers.media_lookups, distances);
            }
            for (const double t : distances)
                rows[row].push_back(camera_point(plane, through, plane.origin + direction * t, direction));
            if (surface) rows[row].push_back(camera_point(plane, through, hit.position, hit.normal));
        }
    });
    std::vector<CameraPoint> points;
    for (const std::vector<CameraPoint>& row : rows) points.insert(points.end(), row.begin(), row.end());
    return points;
}

std::optional<Query> query_of_point(const Vec3d& point, const scene::Receivers& receivers,
                                    const rays::LightView& view) {
    Vec3d place = rays::to_light(view, point);
    if (view.perspective && !(place.z > view.z_near)) return std::nullopt;
    if (receivers.bias > 0.0) place.z -= receivers.bias / rays::length_per_depth(view, place.x, place.y);
    return query_if_seen(place, receivers.filter_width, view);
}

QuerySet queries_of_points(std::span<const CameraPoint> points, const scene::Receivers& receivers,
                           const rays::LightView& view) {
    QuerySet set;
    for (const CameraPoint& point : points) {
        const std::optional<Query> query = query_of_point(point.position, receivers, view);
        append(query, set);
        if (query) set.footprints.push_back(footprint_of(point, view));
    }
    return set;
}

QuerySet point_queries(const scene::Receivers& receivers, const rays::LightView& view) {
    QuerySet set;
    for (const Vec3d& point : receivers.points) append(query_of_point(point, receivers, view), set);
    return set;
}

QuerySet probe_queries(const scene::Receivers& receivers, const rays::LightView& view) {
    QuerySet set;
    const double range = view.z_max - view.z_min;
    for (int i = 0; i < receivers.count; ++i) {
        base::Random random(base::hash(receivers.seed, static_cast<std::uint64_t>(i)));
        Vec3d place;
        place.x = random.uniform(0.0, view.resolution.x);
        place.y = random.uniform(0.0, view.resolution.y);
        place.z = random.uniform(view.z_min, view.z_max + behind * range);
        append(query_if_seen(place, receivers.filter_width, view), set);
    }
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
