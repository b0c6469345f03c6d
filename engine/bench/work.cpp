#include "bench/work.h"

#include <algorithm>
#include <variant>

#include "bench/reference.h"
#include "bench/seen_places.h"
#include "bench/shared_tile.h"
#include "scene/cube_face.h"

namespace shadowbench::bench {
namespace {

// Seconds on one thread: of a primitive in a structure for rays; of a captured ray, of its crossings of surfaces, and
// of its steps through particles and grids.
constexpr double primitive = 0.4e-6, ray = 0.045e-6, segment = 0.06e-6, step = 0.15e-6, grid_step = 0.035e-6;
// Of what techniques share of a ray and of its segments, and of adding them to a map. Lines take the place of
// exponentials in pixels with media: a function within a tolerance of nothing has more of them. The steps of grids are
// thin and follow each other: few lines do for many of them.
constexpr double share_ray = 0.005e-6, share_segment = 0.03e-6, share_media = 0.1e-6, build_ray = 0.005e-6,
                 build_segment = 0.04e-6, build_grid = 0.01e-6, build_media = 0.035e-6, build_fine = 0.07e-6,
                 build_fine_grid = 0.02e-6;
// Of checking the function there. No more than so many rays are checked, and so many finely: see curve_check.cpp.
constexpr double check_ray = 0.02e-6, check_segment = 0.1e-6, check_grid = 0.04e-6, check_media = 0.12e-6,
                 check_fine = 5e-6, check_fine_grid = 1e-6, checked_rays = 1048576.0, fine_rays = 16384.0,
                 fine_bound = 16e-6;
// Of a query to a set of rays, of a ray in its footprint, and of each segment of a ray that lies in one; of a lookup,
// and of a ray of the map in its footprint; of a ray that one traces, and of its segments, about half of which lie
// before the receiver.
constexpr double gather_query = 1.5e-6, gather_ray = 0.02e-6, gather_segment = 0.1e-6, gather_grid = 0.012e-6,
                 one_lookup = 0.15e-6, lookup_ray = 0.01e-6, traced_ray = 0.3e-6, traced_segment = 0.06e-6,
                 traced_part = 0.5;
// Of a ray that Embree traces twice, and of its segments; so many are traced, and so many captured beside them, at
// most.
constexpr double embree_ray = 1e-6, embree_segment = 0.1e-6, compared_rays = 20000.0, captured_beside = 262144.0;

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

double receivers_of(const scene::Scenario& scenario, double reach) {
    const scene::Receivers& receivers = scenario.receivers;
    if (!receivers.points.empty()) return reach * static_cast<double>(receivers.points.size());
    if (!receivers.camera) return receivers.count;
    const ExpectedHits hits = expected_hits(scenario.scene, camera_view(*receivers.camera, receivers.resolution), false,
                                            scenario.rays.media == scene::Media::cells);
    return reach * static_cast<double>(receivers.resolution.x) * receivers.resolution.y *
           (std::clamp(hits.seen, 0.05, 1.0) + hits.media * receivers.media_lookups);
}

// Of a technique that traces: as many as the number says that it trades for accuracy.
double rays_of_a_lookup(const Contender& contender) {
    for (const techniques::Trade& trade : contender.row->traits.trades)
        if (const auto* count = std::get_if<double>(&contender.values.at(trade.parameter))) return *count;
    return 1.0;
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

}  // namespace

LightWork count_work(const scene::Scenario& scenario, std::size_t light, const rays::MapLayout& layout,
                     const rays::LightView& view, std::span<const Contender> contenders) {
    LightWork work;
    work.view = view;
    work.pixels = static_cast<double>(layout.width) * layout.height;
    work.rays = work.pixels * layout.samples();
    const ExpectedHits hits = expected_hits(scenario.scene, view, true, layout.cells);
    work.segments = hits.segments;
    work.steps = hits.steps;
    work.grids = hits.grids;
    work.media = hits.media;
    work.hair_tests = hits.hair_tests;
    work.in_media = layout.media ? hits.segments : 0.0;
    work.truth_segments = hits.segments - hits.grids;
    work.exact = work.truth_segments + expected_hits(scenario.scene, view, true, true).grids;
    work.samples = layout.samples();
    work.channels = layout.channels;
    const scene::Light& source = scenario.lights[light];
    work.reach = source.face ? 1.0 / static_cast<double>(scene::cube_faces.size()) : 1.0;
    work.receivers = receivers_of(scenario, work.reach);
    work.judged = std::min(work.receivers, static_cast<double>(scenario.reference.queries));
    const double side = std::max(1.0, side_in_pixels(source.softness.value_or(scenario.receivers.filter_width), view));
    const double covered = std::min<double>(layout.width, side) * std::min<double>(layout.height, side);
    work.footprint = covered * layout.samples();
    work.truth_pixel_rays = scenario.scene.deep_image ? 1.0 : scenario.reference.samples_per_pixel;
    work.truth_sets = ray_sets(scenario.scene, reference_settings(scenario)).sets;
    work.truth_samples = covered * work.truth_pixel_rays;
    // Whole tiles around the queries are captured, at most all tiles.
    const double tile = static_cast<double>(layout.tile_width) * layout.tile_height;
    const scene::Receivers& receivers = scenario.receivers;
    if (receivers.camera && receivers.points.empty())
        work.seen = seen_share_of_map(scenario.scene, camera_view(*receivers.camera, receivers.resolution), view);
    work.truth_rays = std::min(work.seen * work.pixels, tile * work.judged) * work.truth_pixel_rays;
    work.compared = scenario.scene.deep_image ? 0.0 : std::min(work.rays, compared_rays);
    work.spread_seeds = layout.jittered && scenario.reference.spread_seeds > 1 ? scenario.reference.spread_seeds : 0.0;
    for (const Contender& contender : contenders) {
        const bool traces = contender.row->traits.traces;
        ++(traces ? work.traced : work.techniques);
        if (traces) work.lookup_rays += rays_of_a_lookup(contender);
        work.fine += layout.media && contender.row->error_bound(contender.values, layout) <= fine_bound;
        work.shared = work.shared || shares(contender.needs, layout);
    }
    return work;
}

double structure_seconds(const scene::Scene& scene) {
    double count = 0.0;
    for (const scene::Object& object : scene.objects) count += primitives_of(object);
    return primitive * count;
}

double capture_seconds(const LightWork& work, double rays) {
    const double surfaces = work.segments - work.steps, particles = work.steps - work.grids;
    return rays *
           (ray + (segment * surfaces + step * particles + grid_step * work.grids) * (0.5 + 0.5 * work.channels));
}

double compare_seconds(const LightWork& work) {
    if (!(work.compared > 0.0)) return 0.0;
    return 2.0 * work.compared * (embree_ray + embree_segment * work.segments) +
           capture_seconds(work, std::min(work.rays, captured_beside));
}

double truth_seconds(const LightWork& work, double rays) {
    return rays * (ray + segment * work.truth_segments * (0.5 + 0.5 * work.channels));
}

double build_seconds(const LightWork& work) {
    const double surfaces = work.segments - work.in_media, thick = work.in_media - work.grids;
    const double once = work.shared ? share_ray + share_segment * (surfaces + work.grids) + share_media * thick : 0.0;
    const double each = build_ray + build_segment * surfaces + build_grid * work.grids + build_media * thick;
    const double fine = build_fine_grid * work.grids + build_fine * thick;
    return work.rays * work.channels * (once + work.techniques * each + work.fine * fine);
}

double check_seconds(const LightWork& work) {
    const double surfaces = work.segments - work.in_media, thick = work.in_media - work.grids;
    const double each = check_ray + check_segment * surfaces + check_grid * work.grids + check_media * thick;
    const double fine = check_fine_grid * work.grids + check_fine * thick;
    return work.channels * (std::min(work.rays, checked_rays) * work.techniques * each +
                            std::min(work.rays, fine_rays) * work.fine * fine);
}

double traced_lookup_seconds(const LightWork& work) {
    return work.channels * work.lookup_rays *
           (traced_ray + hair_test * work.hair_tests + traced_segment * traced_part * work.exact);
}

double lookups_seconds(const LightWork& work, double queries) {
    const double in_a_map = work.channels * (one_lookup + lookup_ray * std::min(work.footprint, work.rays));
    return queries * (work.techniques * in_a_map + traced_lookup_seconds(work));
}

double gather_seconds(const LightWork& work, double queries, double samples, double rays, double sets) {
    const double pairs = queries * samples, through_media = std::max(work.media, 1e-3);
    // Queries lie where there are media to see.
    const double marched = std::min(pairs / through_media, rays);
    return queries * sets * gather_query +
           work.channels * (pairs * gather_ray + std::min(pairs, rays) * gather_segment * work.truth_segments +
                            marched * gather_grid * (work.exact - work.truth_segments));
}

}  // namespace shadowbench::bench
