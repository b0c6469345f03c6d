#include "bench/time_light.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "bench/build_timing.h"
#include "bench/clock.h"
#include "bench/disturbance.h"
#include "bench/lookup_timing.h"
#include "bench/memory.h"
#include "bench/repeat.h"
#include "results/settled.h"

namespace shadowbench::bench {
namespace {

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

using BuildSeconds = std::vector<std::vector<double>>;  // of each contender, one value a round

std::vector<double> milliseconds(std::vector<double> seconds) {
    for (double& s : seconds) s *= 1e3;
    return seconds;
}

constexpr double longest_warm_builds = 0.5;  // seconds of a round: of longer ones, a cold start is a small share

// Builds all techniques, untimed: the caches and the allocator are then as one build leaves them to the next. Returns
// the seconds that this took.
double warm_builds(std::span<Contender> contenders, const RaySource& source, const techniques::BuildInput& input,
                   std::size_t room) {
    const Stopwatch stopwatch;
    BuildSeconds seconds(contenders.size());
    results::TimedPasses passes;
    time_builds(contenders, source, input, seconds, passes, room);
    return stopwatch.seconds();
}

// Those of contenders that failed meanwhile do not count.
bool all_narrow(std::span<const Contender> contenders, const std::vector<LookupMeasurement>& plans, double goal,
                const std::function<std::vector<double>(const LookupMeasurement&)>& times) {
    return std::all_of(plans.begin(), plans.end(), [&](const LookupMeasurement& measured) {
        return !contenders[measured.contender].ok() ||
               results::is_narrow(results::summarise(times(measured)), goal);
    });
}

void add(const results::TimedPasses& some, results::TimedPasses& all) {
    all.passes += some.passes;
    all.interrupted += some.interrupted;
    all.switches += some.switches;
}

}  // namespace

results::TimingReport time_light(const LightJob& job, std::span<Contender> contenders, const RaySource& source,
                                 const techniques::BuildInput& input, const Asked& asked) {
    results::TimingReport report;
    report.goal = job.scenario.timing.goal;
    const std::optional<double> steal_before = steal_seconds();
    const Stopwatch stopwatch;
    const scene::Timing& timing = job.scenario.timing;
    BuildSeconds seconds(contenders.size());
    std::vector<LookupMeasurement> plans = plan_all(job, contenders, asked);
    const RepeatRule rule{static_cast<std::size_t>(timing.repetitions),
                          static_cast<std::size_t>(timing.most_repetitions), timing.seconds};
    const std::size_t room = room_beside(contenders, source, job.limits);
    const bool warm = warm_builds(contenders, source, input, room) <= longest_warm_builds;
    const auto builds = [&](std::size_t r) {
        if (warm && r > 0) warm_builds(contenders, source, input, room);
        time_builds(contenders, source, input, seconds, report.builds, room);
        if (job.watch) job.watch("timing builds", r + 1, rule.most);
    };
    const auto lookups = [&](std::size_t r) {
        const base::ThreadLimit one_thread(1);
        for (LookupMeasurement& measured : plans)
            if (const Contender& contender = contenders[measured.contender]; contender.ok())
                time_repetition(contender.maps, measured.plan, r % 2 == 1);
        if (job.watch) job.watch("timing lookups", r + 1, rule.most);
    };
    const auto narrow = [&](const auto& times) { return all_narrow(contenders, plans, timing.goal, times); };
    const RoundPart parts[] = {
        {builds,
         [&] {
             return narrow([&](const LookupMeasurement& one) { return milliseconds(seconds[one.contender]); });
         }},
        {lookups, [&] {
             return narrow([](const LookupMeasurement& one) { return one.plan.image.ns; }) &&
                    narrow([](const LookupMeasurement& one) { return one.plan.random.ns; });
         }}};
    repeat(rule, parts);
    report.seconds = stopwatch.seconds();
    if (const std::optional<double> after = steal_seconds(); after && steal_before)
        report.steal_seconds = std::max(0.0, *after - *steal_before);

    for (const LookupMeasurement& measured : plans) {
        Contender& contender = contenders[measured.contender];
        if (!contender.ok()) continue;
        // Many more places are timed than judged; their answers must be valid too.
        for (const LookupOrder* order : {&measured.plan.image, &measured.plan.random}) {
            check_answers(contender, order->asked(), order->answers);
            add(order->passes, report.lookups);
        }
        if (!contender.ok()) continue;
        results::CellTimes times;
        times.build_ms = results::summarise(milliseconds(std::move(seconds[measured.contender])));
        times.ns_per_segment =
            source.segments() ? 1e6 * times.build_ms.median / static_cast<double>(source.segments()) : 0.0;
        times.image_order = summarise(measured.plan.image);
        times.random_order = summarise(measured.plan.random);
        times.lookups = measured.plan.image.queries.size();
        contender.cell.times = std::move(times);
    }
    return report;
}

}  // namespace shadowbench::bench
