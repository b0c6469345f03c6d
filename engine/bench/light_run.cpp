#include "bench/light_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "bench/agreement.h"
#include "bench/build_timing.h"
#include "bench/clock.h"
#include "bench/lookup_timing.h"
#include "bench/prepared_light.h"
#include "bench/queries.h"
#include "bench/ray_source.h"
#include "bench/reference.h"
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

results::ReferenceReport report_reference(const LightJob& job, const rays::LightView& view,
                                          const rays::MapLayout& layout, std::span<const Query> judged,
                                          const Truth& truth) {
    results::ReferenceReport report;
    const metrics::ErrorNorms error = metrics::error_norms(truth.standard_error);
    report.judged = judged.size();
    report.samples_per_pixel = job.scenario.scene.deep_image ? 1 : job.scenario.reference.samples_per_pixel;
    report.error_rms = error.rms;
    report.error_max = error.max;
    report.noise_tolerance = 0.5 / std::sqrt(static_cast<double>(layout.samples()));
    const int seeds = job.scenario.reference.spread_seeds;
    if (seeds < 2) return report;
    const Spread spread =
        spread_over_seeds(job.scenario.scene, view, job.scenario.rays, seeds, judged, stage(job, "spread over seeds"));
    report.spread_rms = spread.rms;
    report.spread_max = spread.max;
    return report;
}

struct LookupMeasurement {
    std::size_t contender;
    LookupPlan plan;
};

std::vector<LookupMeasurement> plan_all(const LightJob& job, std::span<const Contender> contenders,
                                        const Asked& asked) {
    const base::ThreadLimit one_thread(1);
    std::vector<LookupMeasurement> plans;
    for (std::size_t i = 0; i < contenders.size(); ++i)
        if (contenders[i].ok())
            plans.push_back(
                {i, plan_lookups(contenders[i].maps, asked, static_cast<std::size_t>(job.scenario.timing.lookups),
                                 job.scenario.receivers.seed)});
    return plans;
}

// Times builds and lookups, interleaved: every technique once, then every technique again.
void time_all(const LightJob& job, std::span<Contender> contenders, const RaySource& source,
              const techniques::BuildInput& input, const Asked& asked) {
    const std::size_t repetitions = static_cast<std::size_t>(job.scenario.timing.repetitions);
    // The first builds do not count: they find the allocator and the caches as the checks left them.
    std::vector<std::vector<double>> seconds(contenders.size()), warming(contenders.size());
    time_builds(contenders, source, input, warming);
    for (std::size_t r = 0; r < repetitions; ++r) {
        time_builds(contenders, source, input, seconds);
        if (job.watch) job.watch("timing builds", r + 1, repetitions);
    }
    std::vector<LookupMeasurement> plans = plan_all(job, contenders, asked);
    for (std::size_t r = 0; r < repetitions; ++r) {
        const base::ThreadLimit one_thread(1);
        for (LookupMeasurement& measured : plans)
            time_repetition(contenders[measured.contender].maps, measured.plan, r % 2 == 1);
        if (job.watch) job.watch("timing lookups", r + 1, repetitions);
    }
    for (const LookupMeasurement& measured : plans) {
        // Many more places are timed than judged; their answers must be valid too.
        for (const LookupOrder* order : {&measured.plan.image, &measured.plan.random})
            check_answers(contenders[measured.contender], order->asked(), order->answers);
        if (!contenders[measured.contender].ok()) continue;
        results::CellTimes times;
        for (double& s : seconds[measured.contender]) s *= 1e3;
        times.build_ms = results::summarise(std::move(seconds[measured.contender]));
        times.ns_per_segment =
            source.segments() ? 1e6 * times.build_ms.median / static_cast<double>(source.segments()) : 0.0;
        times.image_order = summarise(measured.plan.image);
        times.random_order = summarise(measured.plan.random);
        times.lookups = measured.plan.image.queries.size();
        contenders[measured.contender].cell.times = std::move(times);
    }
}

results::LightResult describe(const LightJob& job, const rays::MapLayout& layout, const QuerySet& set) {
    results::LightResult result;
    result.name = light_of(job).name;
    result.layout = {layout.width, layout.height,   layout.samples_x, layout.samples_y, layout.jittered,
                     layout.seed,  layout.channels, layout.media,     layout.z_min,     layout.z_max};
    result.deep_image = job.scenario.scene.deep_image.has_value();
    result.receivers = set.queries.size();
    result.dropped = set.dropped;
    return result;
}

void report_capture(const RaySource& source, double setup_seconds, results::LightResult& result) {
    result.rays = source.rays();
    result.segments = source.segments();
    result.ray_bytes = source.bytes();
    result.kept = source.kept();
    result.translucent = source.translucent();
    result.times = {source.seconds(), setup_seconds, static_cast<double>(source.rays()) / source.seconds()};
}

}  // namespace

results::LightResult run_light(const LightJob& job, std::vector<Contender> contenders) {
    const scene::Scene& scene = job.scenario.scene;
    const auto [view, layout, least] = prepare_light(job.scenario, job.light, contenders, job.limits);
    const techniques::BuildInput input{layout, view, job.casters};
    if (scene.deep_image) check_served(contenders, input);
    const QuerySet set = scenario_queries(job.scenario, light_of(job), job.seen, view);
    results::LightResult result = describe(job, layout, set);

    const Stopwatch setup;
    const rays::Capture capture(scene, view, layout);
    const double setup_seconds = setup.seconds();
    const RaySource source(capture, layout, job.limits.kept_rays, stage(job, "capture", layout));
    report_capture(source, setup_seconds, result);
    if (job.casters) result.agreement = compare_with_tracer(capture, layout, view, *job.casters, agreement_rays);

    const QuerySet judged = judged_queries(job.scenario, set);
    const Truth truth = find_truth(job, view, judged.queries);
    result.reference = report_reference(job, view, layout, judged.queries, truth);

    build_all(contenders, source, input, job.limits.all, stage(job, "build", layout));
    check_functions(contenders, source, layout, stage(job, "check", layout));
    check_lookups(contenders, judged.asked(), truth);
    if (results::sees_nothing(result)) check_lit(contenders);
    time_all(job, contenders, source, input, set.asked());

    for (Contender& contender : contenders) {
        judge(contender.cell, contender.promises, result.reference.noise_tolerance);
        result.cells.push_back(std::move(contender.cell));
    }
    results::mark_fronts(result.cells);
    return result;
}

}  // namespace shadowbench::bench
