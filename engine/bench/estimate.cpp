#include "bench/estimate.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace shadowbench::bench {
namespace {

// Seconds on one thread: of a captured ray and of each of its segments; of adding a segment to a map, and of checking
// the function there; of a segment in the footprint of a truth; of a lookup, and of a ray that one traces.
constexpr double ray = 0.1e-6, segment = 0.12e-6, build_ray = 0.02e-6, build = 0.3e-6, check_ray = 0.04e-6,
                 check = 0.3e-6, gather = 0.01e-6, one_lookup = 0.15e-6, lookup_ray = 0.01e-6, traced_ray = 0.5e-6,
                 traced_segment = 0.015e-6;
// Of a primitive in the structures for rays; of a ray of a camera and of a point that it finds; of writing and
// comparing a pixel of one technique.
constexpr double primitive = 0.4e-6, view_ray = 1e-6, point = 0.2e-6, picture_pixel = 3e-6;
// Seconds of a timed round of a technique: its passes take no longer, however many lookups there are.
constexpr double longest_pass = 0.01, least_pass = 0.002, warming = 0.025, longest_warm = 0.1;
constexpr double smallest_pass_lookups = 64.0, embree_rays = 20000.0, embree_ray = 2e-6, capture_checked = 262144.0;
constexpr double media_lookups_of_pictures = 128.0;
// What each technique costs however small the map is: its rows, its floors, its checks.
constexpr double technique = 0.03;

double side_in_pixels(const scene::FilterWidth& width, const rays::LightView& view) {
    switch (width.unit) {
        case scene::WidthUnit::share:
            return width.value * view.resolution.x;
        case scene::WidthUnit::length:
            return width.value / view.pixel.x / (view.perspective ? 0.5 * (view.z_min + view.z_max) : 1.0);
        default:
            return width.value;
    }
}

double lookups_of(const scene::Scenario& scenario) {
    const scene::Receivers& receivers = scenario.receivers;
    if (!receivers.points.empty()) return static_cast<double>(receivers.points.size());
    if (!receivers.camera) return receivers.count;
    const ExpectedHits hits = expected_hits(scenario.scene, camera_view(*receivers.camera, receivers.resolution), false,
                                            scenario.rays.media == scene::Media::cells);
    return static_cast<double>(receivers.resolution.x) * receivers.resolution.y *
           (std::clamp(hits.seen, 0.05, 1.0) + hits.media * receivers.media_lookups);
}

double primitives_of(const scene::Object& object) {
    if (const auto* mesh = std::get_if<scene::Mesh>(&object.shape)) return static_cast<double>(mesh->triangles.size());
    if (const auto* hair = std::get_if<scene::Hair>(&object.shape)) return static_cast<double>(hair->points.size());
    if (const auto* spheres = std::get_if<scene::Spheres>(&object.shape))
        return static_cast<double>(spheres->centres.size());
    if (const auto* particles = std::get_if<scene::Particles>(&object.shape))
        return static_cast<double>(particles->centres.size());
    return 0.1 * static_cast<double>(std::get<scene::GridVolume>(object.shape).density.size());  // its empty blocks
}

double primitives_of(const scene::Scene& scene) {
    double count = 0.0;
    for (const scene::Object& object : scene.objects) count += primitives_of(object);
    return count;
}

// The rounds that a rule makes: as many as it must, and about half way, in powers, to as many as it may, within its
// seconds.
double rounds_of(const scene::Timing& timing, double seconds_a_round) {
    const double least = timing.repetitions, most = timing.most_repetitions;
    const double beyond = std::max(0.0, std::sqrt(least * std::max(most, least)) - least);
    return least + std::min(beyond, timing.seconds / std::max(seconds_a_round, 1e-9));
}

// The passes of one technique in a round, in image order and at random, with those that warm the caches and the floors.
double passes_of(double lookups, double seconds_a_lookup) {
    const double once = seconds_a_lookup * std::min(lookups, smallest_pass_lookups);
    const double pass = std::clamp(seconds_a_lookup * lookups, once, std::max(once, longest_pass));
    if (pass > longest_warm) return 2.0 * pass;
    const double timed = std::max(pass, least_pass);
    return std::clamp(warming, 2.0 * pass, 4.0 * pass) + 2.0 * pass + 3.0 * timed;
}

double capture_of(double rays, const LightWork& work) {
    return rays * (ray + segment * work.segments * (0.5 + 0.5 * work.channels));
}

double build_of(const LightWork& work) {
    return work.rays * work.channels * (build_ray + build * work.segments);
}

double lookup_of(const LightWork& work) {
    return work.channels * (one_lookup + lookup_ray * std::min(work.footprint, work.rays));
}

double traced_lookup_of(const LightWork& work) {
    return one_lookup + std::min(work.footprint, work.rays) * (traced_ray + traced_segment * work.segments);
}

// All lookups of all techniques to this many queries, once.
double lookups_of(const LightWork& work, double queries) {
    return queries * (work.techniques * lookup_of(work) + work.traced * traced_lookup_of(work));
}

double gather_of(const LightWork& work, double queries) {
    return queries * work.truth_samples * work.channels * gather * (1.0 + work.segments);
}

}  // namespace

LightWork count_work(const scene::Scenario& scenario, const rays::MapLayout& layout, const rays::LightView& view,
                     std::span<const Contender> contenders) {
    LightWork work;
    work.pixels = static_cast<double>(layout.width) * layout.height;
    work.rays = work.pixels * layout.samples();
    work.segments = expected_hits(scenario.scene, view, true, layout.cells).segments;
    work.channels = layout.channels;
    work.receivers = lookups_of(scenario);
    work.judged = std::min(work.receivers, static_cast<double>(scenario.reference.queries));
    const double side = std::max(1.0, side_in_pixels(scenario.receivers.filter_width, view));
    const double covered = std::min(work.pixels, side * side);
    work.footprint = covered * layout.samples();
    work.truth_pixel_rays = scenario.scene.deep_image ? 1.0 : scenario.reference.samples_per_pixel;
    work.truth_samples = covered * work.truth_pixel_rays;
    // Whole tiles around the queries are captured, at most all tiles.
    const double tile = static_cast<double>(layout.tile_width) * layout.tile_height;
    work.truth_rays = std::min(work.pixels, tile * work.judged) * work.truth_pixel_rays;
    work.spread_seeds = layout.jittered && scenario.reference.spread_seeds > 1 ? scenario.reference.spread_seeds : 0.0;
    for (const Contender& contender : contenders) ++(contender.row->traits.traces ? work.traced : work.techniques);
    return work;
}

double estimate_seconds(const LightWork& work, const scene::Timing& timing, int threads) {
    // Of all threads: the truth, the rays and maps of each seed and of the light, and the check of each function.
    const double all = work.techniques * build_of(work);
    const double shared =
        capture_of(work.truth_rays, work) + gather_of(work, work.judged) +
        (1.0 + work.spread_seeds) * (capture_of(work.rays, work) + all + lookups_of(work, work.judged)) +
        work.techniques * work.rays * work.channels * (check_ray + check * work.segments);
    const double compared = std::min(work.rays, embree_rays) * (embree_ray + segment * work.segments) +
                            capture_of(std::min(work.rays, capture_checked), work);
    // Of one thread: the rounds of builds, each after one that warms the caches, and of lookups.
    const double lookups = std::min(work.receivers, static_cast<double>(timing.lookups));
    const double round = 2.0 * all + work.techniques * passes_of(lookups, lookup_of(work)) +
                         work.traced * passes_of(lookups, traced_lookup_of(work));
    return technique * (work.techniques + work.traced) + shared / threads + compared + rounds_of(timing, round) * round;
}

double estimate_loading(const scene::Scenario& scenario, int threads) {
    const scene::Receivers& receivers = scenario.receivers;
    const double rays = receivers.camera ? static_cast<double>(receivers.resolution.x) * receivers.resolution.y : 0.0;
    return 2.0 * primitive * primitives_of(scenario.scene) + view_ray * rays / threads;
}

double estimate_pictures(const scene::Scenario& scenario, std::span<const LightWork> lights, int threads) {
    if (scenario.scene.deep_image || lights.empty()) return 0.0;
    const scene::Receivers& receivers = scenario.receivers;
    const double pixels = static_cast<double>(receivers.resolution.x) * receivers.resolution.y;
    ExpectedHits hits{1.0, 1.0, 0.0};
    if (receivers.camera)
        hits = expected_hits(scenario.scene, camera_view(*receivers.camera, receivers.resolution), false, false);
    const double points = pixels * (hits.seen + media_lookups_of_pictures * hits.media);
    const double techniques = lights[0].techniques + lights[0].traced;
    double shared = pixels * view_ray + points * point + pixels * picture_pixel * (1.0 + techniques);
    for (const LightWork& work : lights)
        shared += capture_of(work.rays + work.pixels * work.truth_pixel_rays, work) + work.techniques * build_of(work) +
                  lookups_of(work, points) + gather_of(work, points) + techniques * points * point;
    return shared / threads + 2.0 * primitive * primitives_of(scenario.scene);
}

}  // namespace shadowbench::bench
