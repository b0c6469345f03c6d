#include "bench/camera_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/random.h"

namespace shadowbench::bench {
namespace {

using base::Vec3d;

constexpr std::uint64_t which_surface = 0x73757266616365;  // separates these random numbers from others

struct Span {
    double front, back;
};

// The parts of the ray inside any medium: disjoint, in order.
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

// Transmittance of media along a ray, passed from front to back.
class Passed {
public:
    explicit Passed(const std::vector<rays::TracedSegment>& segments) : segments_(segments) {}

    // Multiplies `left` by what is left of the light from the last t to this one.
    void on_to(double t, Vec3d& left) {
        while (first_ < segments_.size() && segments_[first_].back <= t_) ++first_;
        for (std::size_t i = first_; i < segments_.size() && segments_[i].front < t; ++i) {
            const rays::TracedSegment& s = segments_[i];
            const double length = std::min(t, s.back) - std::max(t_, s.front);
            if (!(length > 0.0)) continue;
            for (int c = 0; c < 3; ++c) left[c] *= std::pow(s.transmittance[c], length / (s.back - s.front));
        }
        t_ = std::max(t_, t);
    }

private:
    const std::vector<rays::TracedSegment>& segments_;
    std::size_t first_ = 0;  // all before it end before t_
    double t_ = 0.0;
};

// Memory that the view rays of a row reuse.
struct Scratch {
    std::vector<rays::SurfaceHit> surfaces;
    std::vector<rays::TracedSegment> segments;
    std::vector<double> distances;
};

void see_pixel(const scene::Receivers& receivers, const rays::Tracer& tracer, const rays::ImagePlane& plane, int x,
               int y, Scratch& scratch, std::vector<CameraPoint>& out) {
    const Vec3d through = plane.through(x + 0.5, y + 0.5), direction = through.normalized();
    auto& [surfaces, segments, distances] = scratch;
    const bool ends = tracer.surfaces(plane.origin, direction, surfaces, scene::mid_shutter);
    segments.clear();
    if (tracer.has_media() && (receivers.media_lookups > 0 || surfaces.size() > 1)) {
        const double end = ends ? surfaces.back().t : std::numeric_limits<double>::infinity();
        tracer.all_segments(plane.origin, direction, 0.0, end, segments, scene::mid_shutter);
        std::erase_if(segments, [](const rays::TracedSegment& s) { return !(s.front < s.back); });
        distances.clear();
        spread(media_spans(segments), receivers.media_lookups, distances);
        for (const double t : distances)
            out.push_back(camera_point(plane, through, plane.origin + direction * t, direction));
    }
    if (surfaces.empty()) return;
    const auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(receivers.resolution.x) +
                       static_cast<std::uint64_t>(x);
    const double u = base::to_unit(base::hash(receivers.seed, pixel, which_surface));
    const rays::SurfaceHit& drawn = surfaces[draw_surface(surfaces, segments, u)];
    out.push_back(camera_point(plane, through, drawn));
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

CameraPoint camera_point(const rays::ImagePlane& plane, const Vec3d& through, const rays::SurfaceHit& hit) {
    CameraPoint point = camera_point(plane, through, hit.position, hit.normal);
    if (hit.tangent == Vec3d(0.0)) point.normal = hit.normal;
    return point;
}

std::size_t draw_surface(const std::vector<rays::SurfaceHit>& surfaces,
                         const std::vector<rays::TracedSegment>& segments, double u) {
    if (surfaces.size() == 1) return 0;
    thread_local std::vector<double> seen;  // cumulative shares, up to and including each surface
    seen.clear();
    Vec3d left(1.0);
    Passed media(segments);
    double sum = 0.0;
    for (const rays::SurfaceHit& hit : surfaces) {
        media.on_to(hit.t, left);
        sum += left.dot(hit.opacity);
        seen.push_back(sum);
        left *= Vec3d(1.0) - hit.opacity;
    }
    const auto drawn = std::upper_bound(seen.begin(), seen.end(), u * sum);
    if (drawn == seen.end()) return 0;
    return static_cast<std::size_t>(drawn - seen.begin());
}

std::vector<CameraPoint> camera_points(const scene::Receivers& receivers, const rays::Tracer& tracer) {
    const base::Vec2i resolution = receivers.resolution;
    const rays::ImagePlane plane = rays::make_image_plane(*receivers.camera, resolution);
    std::vector<std::vector<CameraPoint>> rows(static_cast<std::size_t>(resolution.y));
    base::parallel_for(rows.size(), [&](std::size_t row) {
        Scratch scratch;
        for (int x = 0; x < resolution.x; ++x)
            see_pixel(receivers, tracer, plane, x, static_cast<int>(row), scratch, rows[row]);
    });
    std::vector<CameraPoint> points;
    for (const std::vector<CameraPoint>& row : rows) points.insert(points.end(), row.begin(), row.end());
    return points;
}

}  // namespace shadowbench::bench
