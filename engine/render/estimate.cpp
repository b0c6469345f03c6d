#include "render/estimate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <variant>
#include <vector>

#include "bench/estimate.h"
#include "bench/expected_hits.h"
#include "bench/seen_places.h"
#include "render/default_view.h"
#include "render/picture_size.h"

namespace shadowbench::render {
namespace {

// Seconds: of a view ray, and of each surface, ball and cell of a grid that it meets; of a point that it finds, and of
// that in the pictures of a technique.
constexpr double view_ray = 0.6e-6, view_segment = 0.7e-6, view_grid = 0.07e-6, found = 0.4e-6, point = 0.2e-6;
// Of a pixel of a technique: comparing its pictures on all threads, and coding them for files on one.
constexpr double compared_pixel = 1.2e-6, written_pixel = 0.6e-6;
// Points that a pixel looks up for each surface or step that one of its view rays meets, and for each hair: its other
// rays see most of the former again, and half of the latter.
constexpr double joined = 1.3, joined_hair = 2.1;
// Points whose truth is found at a time; each time the rays of the whole map are captured again.
constexpr double points_at_a_time = 524288.0;
// With more points, pictures end for lack of memory, after a band of so many rows.
constexpr double most_points = 3e7, rows_of_a_band = 32.0;

// The longest way through all media.
double diagonal_of_media(const scene::Scene& scene) {
    base::Box3d box;
    for (const scene::Object& object : scene.objects)
        if (std::holds_alternative<scene::GridVolume>(object.shape) ||
            std::holds_alternative<scene::Particles>(object.shape))
            box.extendBy(scene::bounds(object));
    return box.isEmpty() ? 0.0 : box.size().length();
}

struct Seen {
    rays::LightView camera;
    std::vector<double> points;  // of each object
    double seconds_a_ray = view_ray;
};

Seen what_is_seen(const scene::Scenario& scenario, base::Vec2i size) {
    Seen seen;
    seen.camera = bench::camera_view(scenario.receivers.camera.value_or(default_camera(scenario.scene)), size);
    const double pixels = static_cast<double>(size.x) * size.y, diagonal = diagonal_of_media(scenario.scene);
    for (const scene::Object& object : scenario.scene.objects) {
        const bench::ExpectedHits hits = bench::expected_hits(object, seen.camera, true, 1.0 / usual_rays_per_side);
        const double steps = diagonal > 0.0 ? usual_media_lookups * std::min(1.0, hits.inside / diagonal) : 0.0;
        const bool hair = std::holds_alternative<scene::Hair>(object.shape);
        seen.points.push_back(pixels * ((hair ? joined_hair : joined) * hits.seen + joined * steps));
        seen.seconds_a_ray += view_segment * (hits.seen + hits.steps - hits.grids) + view_grid * hits.grids +
                              bench::hair_test * hits.hair_tests;
    }
    return seen;
}

// Points outside a map are lit.
double points_in_map(const scene::Scene& scene, const Seen& seen, const bench::LightWork& work) {
    double points = 0.0;
    for (std::size_t i = 0; i < seen.points.size(); ++i)
        points += seen.points[i] * bench::share_in_map(scene.objects[i], seen.camera, work.view);
    return work.reach * points;
}

}  // namespace

double estimate_pictures(const bench::VariantWork& variant, int threads) {
    const auto& [scenario, lights, file_bytes] = variant;
    if (scenario.scene.deep_image || lights.empty()) return 0.0;
    const base::Vec2i size = enlarged(scenario.receivers.resolution);
    const Seen seen = what_is_seen(scenario, size);
    const double pixels = static_cast<double>(size.x) * size.y;
    const double techniques = lights[0].techniques + lights[0].traced;
    const double seeing = pixels * usual_rays_per_side * usual_rays_per_side * seen.seconds_a_ray;
    const double points = std::accumulate(seen.points.begin(), seen.points.end(), 0.0);
    if (points > most_points)
        return bench::estimate_reading(file_bytes) + bench::structure_seconds(scenario.scene) +
               seeing * std::min(1.0, std::max(most_points / points, rows_of_a_band / size.y)) / threads;
    double shared = seeing + points * found + pixels * techniques * compared_pixel;
    for (const bench::LightWork& work : lights) {
        const double reached = points_in_map(scenario.scene, seen, work);
        const double truth_rays = work.seen * work.pixels * work.truth_pixel_rays;
        shared += bench::capture_seconds(work, work.rays) + bench::build_seconds(work) +
                  bench::truth_seconds(work, truth_rays * std::ceil(reached / points_at_a_time)) +
                  bench::lookups_seconds(work, reached) + techniques * points * point +
                  bench::gather_seconds(work, reached, work.truth_samples, truth_rays, work.truth_sets);
    }
    // Tracers of the casters and of all objects, and of each light the captures of its rays and of the truth.
    const double structures = 2.0 + 2.0 * bench::capture_share * static_cast<double>(lights.size());
    return bench::estimate_reading(file_bytes) + structures * bench::structure_seconds(scenario.scene) +
           shared / threads + pixels * (1.0 + techniques) * written_pixel;
}

}  // namespace shadowbench::render
