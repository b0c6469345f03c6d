// How Trials confirms settings: several seeds, all checks of a run, and times in turns.
#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/build_timing.h"
#include "bench/clock.h"
#include "metrics/student.h"
#include "recommend/attempt.h"

namespace shadowbench::recommend {
namespace {

using bench::Contender;
using bench::Stopwatch;

constexpr int seeds = 5;               // of a confirmation, the scenario's own among them
constexpr double capture_share = 0.1;  // seconds of capturing that one repetition times
// A confirmation repeats its times until the interval of each lookup time is this narrow, as a share of the time.
constexpr double narrow = 0.03;
constexpr int least_repetitions = 7, most_repetitions = 21;
constexpr double longest_timing = 15.0;  // seconds, after the least repetitions

}  // namespace

// The truth's own error makes a small rms look larger: the lower end allows for it, the upper end does not.
Confirmed Trials::judge_errors(std::span<const double> errors) const {
    Confirmed confirmed;
    confirmed.mean_error = metrics::mean_and_variance(errors).mean;
    confirmed.error = metrics::mean_interval(errors);
    const double low = std::max(confirmed.error.low, 0.0);
    const double doubt = measure_ == Measure::rms ? truth_rms_ : measure_ == Measure::curve ? 0.0 : truth_max_;
    confirmed.error.low =
        measure_ == Measure::rms ? std::sqrt(std::max(0.0, low * low - doubt * doubt)) : std::max(0.0, low - doubt);
    return confirmed;
}

void Trials::time_builds_of(std::vector<Timed>& timed, std::uint64_t repetition) {
    for (Timed& one : timed) {
        // Captured again if they were dropped.
        const auto rays = store_->rays(choice(one.setting, 0), one.attempt.contender.needs);
        const techniques::BuildInput input{rays->frame->layout, rays->frame->view, casters_.get()};
        std::vector<std::vector<double>> seconds(1);
        results::TimedPasses passes;
        bench::time_builds(std::span(&one.attempt.contender, 1), *rays->source, input, seconds, passes);
        one.build_ms.push_back(1e3 * seconds[0].at(0));
        one.capture_ms.push_back(one.setting.row->traits.traces
                                     ? 0.0
                                     : 1e3 * (rays->setup_seconds + bench::RayStore::seconds_on_one_thread(
                                                                        *rays, capture_share, repetition)));
    }
}

// Builds and lookups in turns: every point once, then every point again, until the lookup times are settled.
void Trials::time(std::vector<Timed>& timed) {
    for (Timed& one : timed) {
        const base::ThreadLimit one_thread(1);
        one.plan = bench::plan_lookups(one.attempt.contender.maps, asked(all_, one.attempt.frame->view).asked(),
                                       static_cast<std::size_t>(scenario_->timing.lookups), scenario_->receivers.seed);
    }
    const auto settled = [](const Timed& one) {
        const metrics::Interval interval = metrics::median_interval(one.plan.random.ns);
        return interval.high - interval.low <= narrow * metrics::median(one.plan.random.ns);
    };
    const Stopwatch stopwatch;
    for (int r = 0; r < most_repetitions; ++r) {
        if (r >= least_repetitions &&
            (stopwatch.seconds() > longest_timing || std::all_of(timed.begin(), timed.end(), settled)))
            return;
        if (progress_)
            progress_({"", "timing", static_cast<std::size_t>(r), static_cast<std::size_t>(most_repetitions)});
        if (r < least_repetitions) time_builds_of(timed, static_cast<std::uint64_t>(r));
        const base::ThreadLimit one_thread(1);
        for (Timed& one : timed) bench::time_repetition(one.attempt.contender.maps, one.plan, r % 2 == 1);
    }
}

std::vector<Confirmed> Trials::confirm(std::span<const Point> points) {
    const Stopwatch stopwatch;
    std::vector<Confirmed> answers(points.size());
    std::vector<std::vector<double>> errors(points.size());
    std::vector<Timed> timed;
    for (int seed = 0; seed < seeds; ++seed)
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (!answers[i].failed.empty()) continue;
            if (progress_)
                progress_({"", "checking", static_cast<std::size_t>(seed) * points.size() + i, seeds * points.size()});
            const Setting setting = space_->setting(points[i]);
            Attempt attempt = this->attempt(setting, seed, false);
            if (attempt.contender.ok() && (seed == 0 || measure_ == Measure::curve))
                bench::check_functions(std::span(&attempt.contender, 1), *attempt.rays->source, attempt.frame->layout,
                                       {});
            if (measure_ == Measure::curve && attempt.contender.ok() && !attempt.contender.cell.curve)
                bench::fail(attempt.contender, no_curve);
            answers[i].failed = attempt.failed();
            if (attempt.contender.ok()) errors[i].push_back(error_of(attempt.contender.cell));
            if (seed > 0 || !attempt.contender.ok()) continue;
            record(setting, *attempt.rays);
            attempt.rays = nullptr;  // many points' rays may not fit into memory together
            timed.push_back({i, setting, std::move(attempt)});
        }
    std::erase_if(timed, [&](const Timed& one) { return !answers[one.index].failed.empty(); });
    time(timed);
    for (Timed& one : timed) {
        Contender& contender = one.attempt.contender;
        for (const bench::LookupOrder* order : {&one.plan.image, &one.plan.random})
            bench::check_answers(contender, order->asked(), order->answers);
        Confirmed& answer = answers[one.index];
        answer.failed = one.attempt.failed();
        if (!answer.failed.empty()) continue;
        answer = judge_errors(errors[one.index]);
        std::vector<double> whole(one.build_ms);
        for (std::size_t r = 0; r < whole.size(); ++r) whole[r] += one.capture_ms[r];
        results::CellTimes& times = contender.cell.times.emplace();
        times.build_ms = results::summarise(one.build_ms);
        times.ns_per_segment = one.attempt.ns_per_segment(times.build_ms.median);
        times.image_order = bench::summarise(one.plan.image);
        times.random_order = bench::summarise(one.plan.random);
        times.lookups = one.plan.image.queries.size();
        const double bytes = static_cast<double>(contender.cell.bytes);
        const results::Sample build = results::summarise(std::move(whole));
        answer.cost = {times.random_order.ns.median, bytes, build.median};
        answer.interval = {times.random_order.ns.interval, metrics::Interval{bytes, bytes}, build.interval};
        keep(*recorded(one.setting), contender);
    }
    seconds_ += stopwatch.seconds();
    return answers;
}

}  // namespace shadowbench::recommend
