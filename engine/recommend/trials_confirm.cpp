// How Trials confirms settings: several seeds, all checks of a run, and times in turns.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "bench/build_timing.h"
#include "bench/clock.h"
#include "metrics/student.h"
#include "recommend/attempt.h"
#include "recommend/error_interval.h"

namespace shadowbench::recommend {
namespace {

using bench::Contender;
using bench::Stopwatch;

constexpr int fewer_seeds = 3;         // of a point whose trial is clear of the error wanted, or if time runs out
constexpr double clear_of = 1.25;      // a trial's RMS that is this factor larger or smaller is
constexpr double capture_share = 0.1;  // seconds of capturing that one repetition times
// A confirmation repeats its times until the interval of each lookup time is this narrow, as a share of the time.
constexpr double narrow = 0.03;
constexpr int least_repetitions = 7, most_repetitions = 101;
constexpr int least_again = 5;        // of what is only timed again
constexpr int shown_repetitions = 3;  // in image order, which is only shown
constexpr double longest_pass = 0.025;   // seconds of lookups in one order
constexpr int shown_builds = 1;          // if build times are only shown
constexpr double longest_timing = 15.0;  // seconds, after the least repetitions, if time is not limited
constexpr double longest_again = 2.0;    // the same, of what is only timed again
// Shares of a confirmation's time after which it goes on with fewer seeds, if builds are asked for, and with fewer
// builds.
constexpr double seeds_share = 0.5, builds_share = 0.85;

}  // namespace

// The builds of all points with the same light rays in turns: rays of several choices may not fit into memory together.
// Returns false if there was time for the fewest repetitions only.
bool Trials::time_builds(std::vector<Timed>& timed, int repetitions, const Stopwatch& stopwatch,
                         double most_seconds) {
    bool all = true;
    for (auto first = timed.begin(); first != timed.end();) {
        const bench::RayChoice rays_of_all = choice(first->setting, 0);
        const auto last = std::find_if(first, timed.end(),
                                       [&](const Timed& one) { return !(choice(one.setting, 0) == rays_of_all); });
        for (int r = 0; r < repetitions; ++r) {
            if (r >= fewer_builds && stopwatch.seconds() > most_seconds) {
                all = false;
                break;
            }
            if (progress_)
                progress_({"", "builds", static_cast<std::size_t>(last - timed.begin()), timed.size()});
            std::shared_ptr<const bench::StoredRays> captured;
            double capture_ms = 0.0;
            for (auto one = first; one != last; ++one) {
                if (!one->attempt.contender.ok()) continue;  // since an earlier repetition
                const auto rays = store_->rays(rays_of_all, one->attempt.contender.needs);
                const techniques::BuildInput input{rays->frame->layout, rays->frame->view, casters_.get()};
                std::vector<std::vector<double>> seconds(1);
                results::TimedPasses passes;
                bench::time_builds(std::span(&one->attempt.contender, 1), *rays->source, input, seconds, passes);
                if (seconds[0].empty()) continue;  // it failed
                one->build_ms.push_back(1e3 * seconds[0][0]);
                const bool charged = !one->setting.row->traits.traces;
                if (charged && rays != captured) {
                    captured = rays;
                    capture_ms = 1e3 * (rays->setup_seconds + bench::RayStore::seconds_on_one_thread(
                                                                  *rays, capture_share, static_cast<std::uint64_t>(r)));
                }
                one->capture_ms.push_back(charged ? capture_ms : 0.0);
            }
        }
        first = last;
    }
    return all;
}

void Trials::plan_lookups(std::vector<Timed>& timed) const {
    const base::ThreadLimit one_thread(1);
    for (Timed& one : timed)
        one.plan = bench::plan_lookups(one.attempt.contender.maps, asked(all_, one.attempt.frame->view).asked(),
                                       one.lookups, scenario_->receivers.seed, false);
}

// Planned lookups in random order, in turns: every point once, then every point again, until the times are settled, or
// for about `longest` seconds, but at least `least` times.
void Trials::time_lookups(std::vector<Timed>& timed, int least, double longest) const {
    const base::ThreadLimit one_thread(1);
    const auto settled = [](const Timed& one) {
        const metrics::Interval interval = metrics::median_interval(one.plan.random.ns);
        return interval.high - interval.low <= narrow * metrics::median(one.plan.random.ns);
    };
    const Stopwatch stopwatch;
    for (int r = 0; r < most_repetitions; ++r) {
        if (r >= least && (stopwatch.seconds() > longest || std::all_of(timed.begin(), timed.end(), settled))) return;
        if (progress_)
            progress_({"", "timing", static_cast<std::size_t>(r), static_cast<std::size_t>(most_repetitions)});
        for (Timed& one : timed) bench::time_order(one.attempt.contender.maps, one.plan, one.plan.random, false);
    }
}

// Maps that would not fit into memory together are left out.
std::vector<std::optional<double>> Trials::time_again(std::span<const Point> points) {
    const Stopwatch stopwatch;
    std::vector<Timed> timed;
    double bytes = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        bytes += trial_of(points[i])->cost[static_cast<std::size_t>(Cost::bytes)];
        if (!timed.empty() && bytes > static_cast<double>(options_.limits.kept_rays / 4)) break;
        const Setting setting = space_->setting(points[i]);
        const auto kept = find_kept(setting);
        Attempt attempt = kept == kept_.end() ? build(setting, 0, false) : take_kept(kept, setting);
        attempt.rays = nullptr;
        if (attempt.contender.ok()) timed.push_back({i, setting, lookups_of(points[i]), std::move(attempt)});
    }
    plan_lookups(timed);
    time_lookups(timed, least_again, longest_again);
    std::vector<std::optional<double>> answers(points.size());
    for (Timed& one : timed) {
        answers[one.index] = metrics::median(one.plan.random.ns);
        keep_map(one.setting, std::move(one.attempt));
    }
    seconds_ += stopwatch.seconds();
    return answers;
}

const Trial* Trials::trial_of(const Point& point) const {
    const auto found =
        std::find_if(trials_.begin(), trials_.end(), [&](const auto& measured) { return measured.first == point; });
    return found == trials_.end() ? nullptr : &found->second;
}

int Trials::seeds_of(const Point& point, double error) const {
    const Trial* trial = trial_of(point);
    if (measure_ != Measure::rms || !trial) return seeds;
    const double ratio = trial->error / error;
    return ratio > clear_of || ratio < 1.0 / clear_of ? fewer_seeds : seeds;
}

// Slow lookups need fewer of them.
std::size_t Trials::lookups_of(const Point& point) const {
    const std::size_t most = static_cast<std::size_t>(scenario_->timing.lookups);
    const Trial* trial = trial_of(point);
    if (!trial) return most;
    const double enough = 1e9 * longest_pass / trial->cost[static_cast<std::size_t>(Cost::lookup)];
    return std::min(most, static_cast<std::size_t>(std::max(enough, 256.0)));
}

std::vector<Confirmed> Trials::confirm(std::span<const Point> points, const Confirming& how) {
    const Stopwatch stopwatch;
    // Points with the same light rays stand together.
    std::vector<std::size_t> by_rays(points.size());
    std::iota(by_rays.begin(), by_rays.end(), std::size_t{0});
    const auto rays_of = [&](std::size_t i) {
        const base::Vec2i sides = space_->resolution(points[i]);
        return std::tuple(sides.x, sides.y, space_->samples(points[i]));
    };
    std::stable_sort(by_rays.begin(), by_rays.end(),
                     [&](std::size_t a, std::size_t b) { return rays_of(a) < rays_of(b); });
    std::vector<Confirmed> answers(points.size());
    std::vector<std::vector<double>> errors(points.size());
    std::vector<double> seconds_a_seed(points.size());
    std::vector<Timed> timed;
    const double seeds_until = (how.builds_asked ? seeds_share : builds_share) * how.most_seconds;
    for (int seed = 0; seed < seeds; ++seed) {
        for (std::size_t done = 0; done < by_rays.size(); ++done) {
            const std::size_t i = by_rays[done];
            if (!answers[i].failed.empty() || answers[i].cut || seed >= seeds_of(points[i], how.error)) continue;
            const Stopwatch of_seed;
            if (seed >= fewer_seeds && stopwatch.seconds() + seconds_a_seed[i] > seeds_until) {
                answers[i].cut = true;
                continue;
            }
            if (progress_)
                progress_({"", "checking", static_cast<std::size_t>(seed) * points.size() + done, seeds * points.size()});
            const Setting setting = space_->setting(points[i]);
            Attempt attempt = build(setting, seed, false);
            judge_lookups(attempt);
            if (attempt.contender.ok() && (seed == 0 || measure_ == Measure::curve))
                bench::check_functions(std::span(&attempt.contender, 1), *attempt.rays->source, attempt.frame->layout,
                                       {});
            if (measure_ == Measure::curve && attempt.contender.ok() && !attempt.contender.cell.curve)
                bench::fail(attempt.contender, no_curve);
            answers[i].failed = attempt.failed();
            if (attempt.contender.ok()) errors[i].push_back(error_of(attempt.contender.cell));
            seconds_a_seed[i] = of_seed.seconds();
            if (seed > 0 || !attempt.contender.ok()) continue;
            record(setting, *attempt.rays);
            attempt.rays = nullptr;  // many points' rays may not fit into memory together
            timed.push_back({i, setting, lookups_of(points[i]), std::move(attempt)});
        }
    }
    const auto drop_failed = [&] {
        std::erase_if(timed, [&](const Timed& one) { return !answers[one.index].failed.empty(); });
    };
    drop_failed();
    const bool builds_cut = !time_builds(timed, how.builds_asked ? least_repetitions : shown_builds, stopwatch,
                                         builds_share * how.most_seconds);
    for (const Timed& one : timed) answers[one.index].failed = one.attempt.failed();
    drop_failed();
    plan_lookups(timed);
    time_lookups(timed, least_repetitions,
                 std::isfinite(how.most_seconds) ? how.lookups_share * how.most_seconds : longest_timing);
    for (Timed& one : timed) {
        const base::ThreadLimit one_thread(1);
        for (int r = 0; r < shown_repetitions; ++r)
            bench::time_order(one.attempt.contender.maps, one.plan, one.plan.image, false);
        Contender& contender = one.attempt.contender;
        for (const bench::LookupOrder* order : {&one.plan.image, &one.plan.random})
            bench::check_answers(contender, order->asked(), order->answers);
        Confirmed& answer = answers[one.index];
        answer.failed = one.attempt.failed();
        if (!answer.failed.empty()) continue;
        answer.error = error_interval(errors[one.index], measure_, truth_doubt_);
        answer.mean_error = metrics::mean_and_variance(errors[one.index]).mean;
        answer.cut = answer.cut || builds_cut;
        answer.lookup_rounds = one.plan.random.ns;
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
