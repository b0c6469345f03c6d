#include "bench/queries.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/parallel.h"
#include "base/random.h"

namespace shadowbench::bench {
namespace {

using base::Vec3d;
using techniques::Query;

constexpr double behind = 0.05;  // of the depth range: how far probes reach behind what casts shadows

struct ImagePlane {
    Vec3d origin, corner, across, down;  // direction of pixel (x, y): corner + x * across + y * down
};

ImagePlane image_plane(const scene::Camera& camera, base::Vec2i resolution) {
    const Vec3d forward = (camera.target - camera.position).normalized();
    Vec3d right = forward.cross(camera.up);
    if (right.length() < 1e-9 * camera.up.length()) right = forward.cross(Vec3d(forward.z, forward.x, forward.y));
    right.normalize();
    const Vec3d up = right.cross(forward);
    const double pixel = 2.0 * std::tan(camera.fov * std::numbers::pi / 360.0) / resolution.y;
    return {camera.position, forward - right * (0.5 * pixel * resolution.x) + up * (0.5 * pixel * resolution.y),
            right * pixel, -up * pixel};
}

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

void append_if_seen(const Vec3d& place, float width, const rays::LightView& view, QuerySet& set) {
    const Query query{static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(place.z), width};
    const bool seen = query.x >= 0.0f && query.y >= 0.0f && query.x < static_cast<float>(view.resolution.x) &&
                      query.y < static_cast<float>(view.resolution.y) && place.z > view.z_near &&
                      std::isfinite(query.z);
    if (seen)
        set.queries.push_back(query);
    else
        ++set.dropped;
}

}  // namespace

std::vector<Vec3d> camera_points(const scene::Receivers& receivers, const rays::Tracer& tracer) {
    const base::Vec2i resolution = receivers.resolution;
    const ImagePlane plane = image_plane(*receivers.camera, resolution);
    std::vector<std::vector<Vec3d>> rows(static_cast<std::size_t>(resolution.y));
    base::parallel_for(rows.size(), [&](std::size_t row) {
        std::vector<rays::TracedSegment> segments;
        std::vector<double> distances;
        for (int x = 0; x < resolution.x; ++x) {
            const Vec3d direction =
                (plane.corner + plane.across * (x + 0.5) + plane.down * (static_cast<double>(row) + 0.5)).normalized();
            rays::SurfaceHit hit;
            const bool surface = tracer.nearest(plane.origin, direction, hit, scene::mid_shutter);
            const double end = surface ? hit.t : std::numeric_limits<double>::infinity();
            distances.clear();
            if (receivers.media_lookups > 0) {
                tracer.all_segments(plane.origin, direction, 0.0, end, segments, scene::mid_shutter);
                spread(media_spans(segments), receivers.media_lookups, distances);
            }
            for (const double t : distances) rows[row].push_back(plane.origin + direction * t);
            if (surface) rows[row].push_back(hit.position);
        }
    });
    std::vector<Vec3d> points;
    for (const std::vector<Vec3d>& row : rows) points.insert(points.end(), row.begin(), row.end());
    return points;
}

QuerySet queries_of_points(const std::vector<Vec3d>& points, const scene::Receivers& receivers,
                           const rays::LightView& view) {
    QuerySet set;
    for (const Vec3d& point : points) {
        Vec3d place = rays::to_light(view, point);
        if (view.perspective && !(place.z > view.z_near)) {
            ++set.dropped;
            continue;
        }
        if (receivers.bias > 0.0) place.z -= receivers.bias / rays::length_per_depth(view, place.x, place.y);
        append_if_seen(place, static_cast<float>(receivers.filter_width), view, set);
    }
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
        append_if_seen(place, static_cast<float>(receivers.filter_width), view, set);
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

}  // namespace shadowbench::bench
