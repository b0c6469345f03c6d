#include "render/render.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/hash_text.h"
#include "base/parallel.h"
#include "bench/contender.h"
#include "bench/load.h"
#include "bench/prepared_light.h"
#include "bench/ray_source.h"
#include "bench/reference.h"
#include "document/document.h"
#include "metrics/statistics.h"
#include "rays/capture.h"
#include "rays/image_plane.h"
#include "render/default_view.h"
#include "render/heat_map.h"
#include "render/point_queries.h"

namespace shadowbench::render {
namespace {

using base::Error;
using base::ErrorCode;
using base::Vec3d;
using bench::Contender;

constexpr std::size_t reference_chunk = std::size_t{1} << 19;  // points: limits the memory for their truth
constexpr float rounding = 1e-6f;                              // by which an answer may leave [0, 1]

struct Work {
    const scene::Scenario& scenario;
    const RenderOptions& options;
    const ShadingPoints& points;
    const rays::Tracer& casters;
    bench::ProgressCallback progress;
};

auto watch(const Work& work, const scene::Light& light, const char* stage, std::size_t total) {
    return [&work, &light, stage, total](std::size_t done) {
        if (work.progress) work.progress({work.scenario.lights.size() > 1 ? light.name : "", stage, done, total});
    };
}

bench::Truth find_truth(const Work& work, const scene::Light& light, const rays::LightView& view,
                        const PointQueries& asked) {
    const std::size_t total = asked.queries.size();
    const scene::RaySettings settings = bench::reference_settings(work.scenario);
    std::vector<bench::Truth> parts;
    for (std::size_t first = 0; first < total; first += reference_chunk) {
        const std::size_t count = std::min(reference_chunk, total - first);
        const auto show = watch(work, light, "reference", total);
        const auto tiles = [&](std::size_t done, std::size_t of) { show(first + count * done / std::max(of, done)); };
        parts.push_back(bench::reference_visibility(work.scenario.scene, view, settings,
                                                    std::span(asked.queries).subspan(first, count), tiles));
    }
    bench::Truth all;
    if (parts.empty()) return all;
    all.channels = parts[0].channels;
    for (int c = 0; c < all.channels; ++c)
        for (const bench::Truth& part : parts) {
            const auto size = static_cast<std::ptrdiff_t>(part.value.size()) / all.channels;
            all.value.insert(all.value.end(), part.value.begin() + c * size, part.value.begin() + (c + 1) * size);
            all.standard_error.insert(all.standard_error.end(), part.standard_error.begin() + c * size,
                                      part.standard_error.begin() + (c + 1) * size);
        }
    return all;
}

// Fails a technique whose map has a fault, or that answers outside [0, 1].
void check_answers(Contender& contender, const std::vector<float>& answers) {
    if (const std::string fault = bench::fault(contender.maps); !fault.empty()) return bench::fail(contender, fault);
    for (const float v : answers)
        if (!(v >= -rounding && v <= 1.0f + rounding))
            return bench::fail(contender, fmt::format("a lookup answers {}, which is not in [0, 1]", v));
}

void render_light(const Work& work, std::size_t index, std::vector<Contender> contenders, Rendering& result) {
    const scene::Scenario& scenario = work.scenario;
    const scene::Light& light = scenario.lights[index];
    const auto [view, layout, least] = bench::prepare_light(scenario, index, contenders, work.options.run.limits);
    const bench::MemoryLimits limits =
        bench::limits_beside(bench::resident_bytes(), layout, contenders, work.options.run.limits);
    const auto tiles = static_cast<std::size_t>(layout.tiles());
    const rays::Capture capture(scenario.scene, view, layout);
    const bench::RaySource source(capture, layout, limits.kept_rays, watch(work, light, "capture", tiles));
    bench::build_all(contenders, source, {layout, view, &work.casters}, limits.all, watch(work, light, "build", tiles));

    result.lights.push_back({light.name, {layout.width, layout.height}, light_map(source, layout)});

    const PointQueries asked = point_queries(work.points, scenario.receivers, view, light.softness);
    const auto looked_up = watch(work, light, "lookup", contenders.size());
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        TechniquePictures& out = result.techniques[i];
        if (out.cell.status == results::CellStatus::failed) continue;
        if (contenders[i].ok()) {
            const std::vector<float> answers = bench::lookup_all(contenders[i].maps, {asked.queries, asked.footprints});
            check_answers(contenders[i], answers);
            if (contenders[i].ok()) add_answers(work.points, index, asked, answers, out.picture);
        }
        out.cell = contenders[i].cell;
        if (!contenders[i].ok()) out.picture = {};
        contenders[i].maps = {};
        looked_up(i + 1);
    }
    const bench::Truth truth = find_truth(work, light, view, asked);
    add_answers(work.points, index, asked, truth.value, result.reference);
    result.reference_standard_error =
        std::max(result.reference_standard_error, metrics::error_norms(truth.standard_error).rms);
}

// Adds the lights that nothing shadows.
void add_fills(const scene::Scenario& scenario, const ShadingPoints& points, Rendering& result) {
    const std::vector<float> lit(scenario.fills.empty() ? 0 : points.points(), 1.0f);
    for (std::size_t fill = 0; fill < scenario.fills.size(); ++fill) {
        const std::size_t light = scenario.lights.size() + fill;
        add_light(points, light, lit, result.reference);
        for (TechniquePictures& pictures : result.techniques)
            if (pictures.cell.status != results::CellStatus::failed) add_light(points, light, lit, pictures.picture);
    }
}

// The legend of the heat maps reaches to the 99th percentile of the median technique's errors, so that one technique
// with large errors does not hide how the others differ.
void compare_all(Rendering& result) {
    std::vector<double> tops;
    for (TechniquePictures& pictures : result.techniques) {
        if (pictures.cell.status == results::CellStatus::failed) continue;
        pictures.shaded = compare(pictures.picture.shaded, result.reference.shaded);
        pictures.shadow = compare(pictures.picture.shadow, result.reference.shadow);
        const std::vector<float> errors = pixel_errors(pictures.picture.shadow, result.reference.shadow);
        tops.push_back(metrics::error_norms(std::vector<double>(errors.begin(), errors.end())).p99);
    }
    if (!tops.empty()) result.heat_top = legend_top(metrics::median(tops));
}

Rendering describe(const scene::Scenario& scenario, const document::Variant& variant, const RenderOptions& options) {
    Rendering result;
    result.name = scenario.name;
    result.hash = base::hash_text(variant.document->dump());
    result.settings = variant.settings;
    result.notes = scene::notes(scenario);
    result.default_camera = !scenario.receivers.camera;
    const base::Vec2i own = scenario.receivers.resolution;
    result.size = options.size.value_or(options.enlarge ? enlarged(own) : own);
    result.rays_per_side = options.rays_per_side;
    result.joined = options.joined;
    const scene::RaySettings truth = bench::reference_settings(scenario);
    const bench::RaySets sets = bench::ray_sets(scenario.scene, truth);
    result.reference_samples = sets.sets * sets.samples_per_pixel;
    return result;
}

ShadingPoints see(const scene::Scenario& scenario, const RenderOptions& options, Rendering& result,
                  const bench::ProgressCallback& progress) {
    result.camera = scenario.receivers.camera
                        ? *scenario.receivers.camera
                        : camera_of_shadows(scenario, result.size, rays::Tracer(scenario.scene, false));
    const rays::ImagePlane view_rays = rays::make_image_plane(result.camera, result.size * options.rays_per_side);
    const rays::ViewedHair viewed{view_rays.origin, (result.camera.target - result.camera.position).normalized(),
                                  0.5 * view_rays.across.length()};
    const rays::Tracer all =
        options.fine_hair ? rays::Tracer(scenario.scene, false, viewed) : rays::Tracer(scenario.scene, false);
    ViewSettings settings;
    settings.camera = result.camera;
    settings.size = result.size;
    settings.media_lookups = options.media_lookups;
    settings.rays_per_side = options.rays_per_side;
    settings.joined = options.joined;
    settings.memory_limit = options.run.limits.all / 2;
    std::vector<scene::Light> lights = scenario.lights;
    lights.insert(lights.end(), scenario.fills.begin(), scenario.fills.end());
    ShadingPoints points =
        find_shading_points(scenario.scene, lights, settings, all, [&](std::size_t done, std::size_t total) {
            if (progress) progress({"", "view rays", done, total});
        });
    if (points.points() == 0)
        throw Error(ErrorCode::bad_input, "/receivers", "the camera sees no surface and no medium");
    return points;
}

}  // namespace

RenderOptions usual_options(const bench::RunOptions& run) {
    RenderOptions options;
    options.run = run;
    options.enlarge = true;
    options.rays_per_side = usual_rays_per_side;
    options.joined = true;
    options.fine_hair = true;
    options.media_lookups = usual_media_lookups;
    return options;
}

Rendering render(const nlohmann::json& document, const RenderOptions& options,
                 const bench::ProgressCallback& progress) {
    const base::ThreadLimit threads(options.run.threads);
    document::Variant variant = document::expand(document).front();
    document::keep_only(variant, options.run.only);
    bench::ScenarioLoader loader(options.run.data);
    const scene::Scenario& scenario = loader.load(variant);
    if (scenario.scene.deep_image)
        throw Error(ErrorCode::bad_input, "/scene/deep_image",
                    "a deep image has no world for a camera; render a scene of objects");
    const std::vector<Contender> contenders = bench::make_contenders(scenario, variant);

    Rendering result = describe(scenario, variant, options);
    const ShadingPoints points = see(scenario, options, result, progress);
    result.points = points.points();
    result.seen = seen_shares(points);
    result.reference = start_picture(points);
    for (const Contender& contender : contenders)
        result.techniques.push_back({contender.cell, start_picture(points), {}, {}});
    const rays::Tracer casters(scenario.scene, true);
    const Work work{scenario, options, points, casters, progress};
    for (std::size_t l = 0; l < scenario.lights.size(); ++l) {
        std::vector<Contender> fresh;
        for (const Contender& c : contenders) fresh.push_back(bench::unbuilt(c));
        render_light(work, l, std::move(fresh), result);
    }
    add_fills(scenario, points, result);
    compare_all(result);
    return result;
}

}  // namespace shadowbench::render
