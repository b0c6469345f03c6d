#include "bench/light_run.h"

#include <cmath>
#include <utility>

#include "base/error.h"
#include "bench/agreement.h"
#include "bench/clock.h"
#include "bench/light_report.h"
#include "bench/over_seeds.h"
#include "bench/prepared_light.h"
#include "bench/queries.h"
#include "bench/ray_source.h"
#include "bench/reference.h"
#include "bench/time_light.h"
#include "bench/verdict.h"
#include "rays/capture.h"
#include "results/fronts.h"

namespace shadowbench::bench {
namespace {

using techniques::Query;

constexpr std::size_t agreement_rays = 20000;

const scene::Light& light_of(const LightJob& job) {
    return job.scenario.lights[job.light];
}

RaySource::Watch stage(const LightJob& job, const char* name, const rays::MapLayout& layout) {
    return [&job, name, total = static_cast<std::size_t>(layout.tiles())](std::size_t done) {
        if (job.watch) job.watch(name, done, total);
    };
}

ReferenceWatch stage(const LightJob& job, const char* name) {
    return [&job, name](std::size_t done, std::size_t total) {
        if (job.watch) job.watch(name, done, total);
    };
}

Truth find_truth(const LightJob& job, const rays::LightView& view, std::span<const Query> judged) {
    return reference_visibility(job.scenario.scene, view, reference_settings(job.scenario), judged,
                                stage(job, "reference"));
}

// Absent values if there are too few seeds.
void find_spread(const LightJob& job, std::span<Contender> contenders, const techniques::BuildInput& input,
                 const Asked& judged, const Truth& truth, results::ReferenceReport& report) {
    const int seeds = job.scenario.reference.spread_seeds;
    if (seeds < 2) return;
    const Spread spread = measure_over_seeds({job.scenario.scene, input, seeds, job.limits}, contenders, judged, truth,
                                             stage(job, "spread over seeds"));
    report.spread_rms = spread.rms;
    report.spread_max = spread.max;
}

}  // namespace

results::LightResult run_light(const LightJob& asked, std::vector<Contender> contenders) {
    const scene::Scene& scene = asked.scenario.scene;
    const auto [view, layout, least] = prepare_light(asked.scenario, asked.light, contenders, asked.limits);
    LightJob job = asked;
    job.limits = limits_beside(resident_bytes(), layout, contenders, asked.limits);
    const techniques::BuildInput input{layout, view, job.casters};
    if (scene.deep_image) check_served(contenders, input);
    const QuerySet set = scenario_queries(job.scenario, light_of(job), job.seen, view);
    results::LightResult result = describe_light(job.scenario, light_of(job), layout, set);

    // Other seeds come before the light's own rays and maps, so that memory holds only one of them at a time.
    const QuerySet judged = judged_queries(job.scenario, set);
    const Truth truth = find_truth(job, view, judged.queries);
    result.reference = report_reference(layout, judged.queries, truth);
    find_spread(job, contenders, input, judged.asked(), truth, result.reference);

    const Stopwatch setup;
    const rays::Capture capture(scene, view, layout);
    const double setup_seconds = setup.seconds();
    RaySource source(capture, layout, job.limits.kept_rays, stage(job, "capture", layout));
    report_capture(source, setup_seconds, result);
    if (job.casters) result.agreement = compare_with_tracer(capture, layout, view, *job.casters, agreement_rays);

    build_all(contenders, source, input, job.limits.all, stage(job, "build", layout));
    check_functions(contenders, source, layout, stage(job, "check", layout));
    check_lookups(contenders, judged.asked(), truth);
    if (results::sees_nothing(result)) check_lit(contenders);
    if (job.times) {
        make_room(contenders, source, job.limits);
        result.timing = time_light(job, contenders, source, input, set.asked());
    }

    for (Contender& contender : contenders) {
        judge(contender.cell, contender.promises, result.reference.noise_tolerance);
        result.cells.push_back(std::move(contender.cell));
    }
    results::mark_fronts(result);
    return result;
}

}  // namespace shadowbench::bench
