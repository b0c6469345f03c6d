#include "render/estimate.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "bench/estimate.h"
#include "bench/expected_hits.h"
#include "render/default_view.h"
#include "render/picture_size.h"

namespace shadowbench::render {
namespace {

// Seconds: of a view ray, and of each surface and step of media that it meets; of a point that it finds.
constexpr double view_ray = 0.6e-6, view_segment = 0.7e-6, point = 0.2e-6;
// Of a pixel of a technique: comparing its pictures on all threads, and coding them for files on one.
constexpr double compared_pixel = 1.2e-6, written_pixel = 0.6e-6;
// Points that a pixel looks up for each surface or step that one of its view rays meets: its other rays see most of
// them again.
constexpr double joined = 1.3;
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

}  // namespace

double estimate_pictures(const bench::VariantWork& variant, int threads) {
    const auto& [scenario, lights, file_bytes] = variant;
    if (scenario.scene.deep_image || lights.empty()) return 0.0;
    const base::Vec2i size = enlarged(scenario.receivers.resolution);
    const scene::Camera camera = scenario.receivers.camera.value_or(default_camera(scenario.scene));
    const bench::ExpectedHits hits =
        bench::expected_hits(scenario.scene, bench::camera_view(camera, size), false, true);
    const double diagonal = diagonal_of_media(scenario.scene);
    const double steps = diagonal > 0.0 ? usual_media_lookups * std::min(1.0, hits.inside / diagonal) : 0.0;

    const double pixels = static_cast<double>(size.x) * size.y;
    const double view_rays = pixels * usual_rays_per_side * usual_rays_per_side;
    const double points = pixels * joined * (hits.seen + steps);
    const double techniques = lights[0].techniques + lights[0].traced;
    const double seeing = view_rays * (view_ray + view_segment * (hits.seen + hits.steps));
    if (points > most_points)
        return bench::estimate_reading(file_bytes) + bench::structure_seconds(scenario.scene) +
               seeing * std::min(1.0, std::max(most_points / points, rows_of_a_band / size.y)) / threads;
    double shared = seeing + pixels * techniques * compared_pixel;
    for (const bench::LightWork& work : lights) {
        const double reached = points * work.reach;
        const double truth_rays = work.pixels * work.truth_pixel_rays;
        shared += bench::capture_seconds(work, work.rays) + bench::build_seconds(work) +
                  bench::truth_seconds(work, truth_rays * std::ceil(reached / points_at_a_time)) +
                  bench::lookups_seconds(work, reached) + techniques * reached * point +
                  bench::gather_seconds(work, reached, work.truth_samples, truth_rays, work.truth_sets);
    }
    // Tracers of the casters and of all objects, and of each light the captures of its rays and of the truth.
    const double structures = 2.0 + 2.0 * bench::capture_share * static_cast<double>(lights.size());
    return bench::estimate_reading(file_bytes) + structures * bench::structure_seconds(scenario.scene) +
           shared / threads + pixels * (1.0 + techniques) * written_pixel;
}

}  // namespace shadowbench::render
