#include "render/shading_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel.h"
#include "bench/queries.h"
#include "rays/image_plane.h"
#include "render/join_points.h"
#include "render/shading.h"
#include "render/view_march.h"
#include "scene/cube_face.h"

namespace shadowbench::render {
namespace {

using base::Vec3d;
using base::Vec3f;

constexpr std::size_t rows_at_a_time = 32;

// The step length: the diagonal of the media's bounds divided by `lookups`. Infinite without media.
double step_length(const scene::Scene& scene, int lookups) {
    base::Box3d box;
    for (const scene::Object& object : scene.objects) {
        if (const auto* grid = std::get_if<scene::GridVolume>(&object.shape)) {
            box.extendBy(scene::world_box(*grid));
        } else if (const auto* puffs = std::get_if<scene::Particles>(&object.shape)) {
            for (std::size_t i = 0; i < puffs->centres.size(); ++i)
                for (const float r : {-puffs->radii[i], puffs->radii[i]})
                    box.extendBy(Vec3d(puffs->centres[i]) + Vec3d(r));
        }
    }
    return box.isEmpty() ? std::numeric_limits<double>::infinity() : box.size().length() / lookups;
}

struct Row {
    std::vector<std::uint32_t> count;  // points of each pixel
    std::vector<Vec3d> place;
    std::vector<Vec3f> across, down, normal;
    std::vector<Vec3f> coverage, radiance;  // radiance: point after point, all lights of a point together
};

struct Eye {
    std::span<const scene::Light> lights;
    const rays::Tracer& tracer;
    rays::ImagePlane plane;  // each of its pixels is a view ray
    double step;
    bool media;
    int rays_per_side;
    bool joined;
};

SeenPoint seen_point(SeenPoint::Kind kind, double t, const bench::CameraPoint& point, const Vec3d& share) {
    return {kind, t, point.position, Vec3f(point.across), Vec3f(point.down), Vec3f(point.normal), Vec3f(share)};
}

// A face of a point light lights only its part of the world.
bool lights_place(const scene::Light& light, const Vec3d& place) {
    return !light.face || scene::cube_face(place - light.position) == *light.face;
}

void add_medium_light(const Eye& eye, const Vec3d& place, const Vec3d& share, PixelPoints& pixel) {
    for (const scene::Light& light : eye.lights)
        pixel.radiance.push_back(lights_place(light, place) ? Vec3f(share * medium_albedo * Vec3d(light.colour))
                                                            : Vec3f(0.0f));
}

void add_surface_light(const Eye& eye, const rays::SurfaceHit& hit, const Vec3d& to_eye, const Vec3d& share,
                       PixelPoints& pixel) {
    for (const scene::Light& light : eye.lights) {
        if (!lights_place(light, hit.position)) {
            pixel.radiance.emplace_back(0.0f);
            continue;
        }
        const Vec3d to_light = towards(light, hit.position);
        const bool hair = hit.tangent != Vec3d(0.0);
        const double shade = hair ? shade_hair(hit.tangent, to_light, to_eye) : shade_surface(hit.normal, to_light);
        pixel.radiance.push_back(Vec3f(share * shade * Vec3d(light.colour)));
    }
}

// Scratch memory that the view rays of a thread reuse.
struct Scratch {
    std::vector<rays::SurfaceHit> surfaces;
    std::vector<rays::TracedSegment> segments;
    ViewMarch march;
    PixelPoints pixel;
};

// Adds the view ray through position (x, y) of the plane, which covers the share `part` of its pixel.
void trace(const Eye& eye, double x, double y, double part, Scratch& scratch) {
    const Vec3d through = eye.plane.through(x, y), direction = through.normalized();
    auto& [surfaces, segments, march, pixel] = scratch;
    const bool ends = eye.tracer.surfaces(eye.plane.origin, direction, surfaces, scene::mid_shutter);
    segments.clear();
    if (eye.media) {
        const double end = ends ? surfaces.back().t : std::numeric_limits<double>::infinity();
        eye.tracer.all_segments(eye.plane.origin, direction, 0.0, end, segments, scene::mid_shutter);
    }
    march_view_ray(segments, surfaces, eye.step, march);
    for (const ViewStep& step : march.steps) {
        const Vec3d place = eye.plane.origin + direction * step.t, share = step.share * part;
        pixel.points.push_back(seen_point(SeenPoint::Kind::medium, step.t,
                                          bench::camera_point(eye.plane, through, place, direction), share));
        add_medium_light(eye, place, share, pixel);
    }
    for (std::size_t i = 0; i < march.surfaces.size(); ++i) {
        if (march.surfaces[i] == Vec3d(0.0)) continue;
        const bool hair = surfaces[i].tangent != Vec3d(0.0);
        const Vec3d share = march.surfaces[i] * part;
        pixel.points.push_back(seen_point(hair ? SeenPoint::Kind::hair : SeenPoint::Kind::surface, surfaces[i].t,
                                          bench::camera_point(eye.plane, through, surfaces[i]), share));
        add_surface_light(eye, surfaces[i], -direction, share, pixel);
    }
}

void add_pixel(const PixelPoints& pixel, Row& row) {
    for (const SeenPoint& point : pixel.points) {
        row.place.push_back(point.place);
        row.across.push_back(point.across);
        row.down.push_back(point.down);
        row.normal.push_back(point.normal);
        row.coverage.push_back(point.coverage);
    }
    row.radiance.insert(row.radiance.end(), pixel.radiance.begin(), pixel.radiance.end());
    row.count.push_back(static_cast<std::uint32_t>(pixel.points.size()));
}

Row trace_row(const Eye& eye, int y, int width) {
    Row row;
    Scratch scratch;
    const int side = eye.rays_per_side;
    const double part = 1.0 / (side * side);
    for (int x = 0; x < width; ++x) {
        scratch.pixel.clear();
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i) trace(eye, x * side + i + 0.5, y * side + j + 0.5, part, scratch);
        if (eye.joined && side > 1) {
            const double width_at_1 =
                side * eye.plane.across.length() / eye.plane.through((x + 0.5) * side, (y + 0.5) * side).length();
            join_points({eye.lights.size(), side, width_at_1, eye.step}, scratch.pixel);
        }
        add_pixel(scratch.pixel, row);
    }
    return row;
}

// Bytes per point: the points, the queries and truth of one light, and one technique's answers.
std::size_t bytes_a_point(std::size_t lights) {
    return sizeof(Vec3d) + sizeof(Vec3f) * (4 + 2 * lights) + 64;
}

void append(const Row& row, std::size_t lights, ShadingPoints& points, std::vector<std::vector<Vec3f>>& radiance) {
    for (const std::uint32_t n : row.count) points.begin.push_back(points.begin.back() + n);
    points.place.insert(points.place.end(), row.place.begin(), row.place.end());
    points.across.insert(points.across.end(), row.across.begin(), row.across.end());
    points.down.insert(points.down.end(), row.down.begin(), row.down.end());
    points.normal.insert(points.normal.end(), row.normal.begin(), row.normal.end());
    points.coverage.insert(points.coverage.end(), row.coverage.begin(), row.coverage.end());
    for (std::size_t i = 0; i < row.radiance.size(); ++i) radiance[i % lights].push_back(row.radiance[i]);
}

}  // namespace

ShadingPoints find_shading_points(const scene::Scene& scene, std::span<const scene::Light> lights,
                                  const ViewSettings& settings, const rays::Tracer& tracer, const ViewWatch& watch) {
    const double step = step_length(scene, settings.media_lookups);
    const rays::ImagePlane plane = rays::make_image_plane(settings.camera, settings.size * settings.rays_per_side);
    const Eye eye{lights, tracer, plane, step, std::isfinite(step), settings.rays_per_side, settings.joined};
    ShadingPoints points;
    points.size = settings.size;
    for (const scene::Light& light : lights) points.lamps += light.face ? 1.0 / scene::cube_faces.size() : 1.0;
    points.begin.push_back(0);
    std::vector<std::vector<Vec3f>> radiance(lights.size());
    const auto height = static_cast<std::size_t>(settings.size.y);
    for (std::size_t first = 0; first < height; first += rows_at_a_time) {
        std::vector<Row> rows(std::min(rows_at_a_time, height - first));
        base::parallel_for(rows.size(), [&](std::size_t i) {
            rows[i] = trace_row(eye, static_cast<int>(first + i), settings.size.x);
        });
        std::size_t count = points.points();
        for (const Row& row : rows) count += row.place.size();
        if (count * bytes_a_point(lights.size()) > settings.memory_limit)
            throw base::Error(base::ErrorCode::bad_input, "/receivers/resolution",
                              fmt::format("the points that {} x {} pixels see take more than half of the memory limit",
                                          settings.size.x, settings.size.y));
        for (const Row& row : rows) append(row, lights.size(), points, radiance);
        if (watch) watch(first + rows.size(), height);
    }
    for (const std::vector<Vec3f>& light : radiance)
        points.radiance.insert(points.radiance.end(), light.begin(), light.end());
    return points;
}

std::vector<float> seen_shares(const ShadingPoints& points) {
    std::vector<float> seen;
    for (std::size_t p = 0; p + 1 < points.begin.size(); ++p) {
        double sum = 0.0;
        for (std::size_t i = points.begin[p]; i < points.begin[p + 1]; ++i)
            for (int c = 0; c < 3; ++c) sum += points.coverage[i][c];
        seen.push_back(static_cast<float>(std::min(sum / 3.0, 1.0)));
    }
    return seen;
}

Picture start_picture(const ShadingPoints& points) {
    return {Image(points.size, Vec3f(0.0f)), Image(points.size, Vec3f(1.0f))};
}

void add_light(const ShadingPoints& points, std::size_t light, std::span<const float> visibility, Picture& picture) {
    const std::size_t count = points.points(), stride = visibility.size() > count ? count : 0;
    const Vec3f* radiance = points.radiance.data() + light * count;
    const double lights = points.lamps;
    const auto width = static_cast<std::size_t>(points.size.x);
    base::parallel_for(static_cast<std::size_t>(points.size.y), [&](std::size_t y) {
        for (std::size_t p = y * width; p < (y + 1) * width; ++p) {
            Vec3d shaded(0.0), taken(0.0);
            for (std::size_t i = points.begin[p]; i < points.begin[p + 1]; ++i)
                for (int c = 0; c < 3; ++c) {
                    const double v = visibility[c * stride + i];
                    shaded[c] += radiance[i][c] * v;
                    taken[c] += points.coverage[i][c] * (1.0 - v);
                }
            picture.shaded.pixels[p] += Vec3f(shaded);
            picture.shadow.pixels[p] -= Vec3f(taken / lights);
        }
    });
}

}  // namespace shadowbench::render
