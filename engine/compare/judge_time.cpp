#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "compare/judge.h"
#include "metrics/two_samples.h"

namespace shadowbench::compare {
namespace {

constexpr double shortest_ms = 0.05;  // of one sample: shorter ones measure the clock and the state of the cache

struct Sides {
    std::vector<double> baseline, current;
};

// The observation of each process: the median of its samples.
std::vector<double> medians(const Timed& timed, bool of_ratios) {
    std::vector<double> values;
    for (const Process& process : timed.processes)
        values.push_back(metrics::median(of_ratios ? process.ratio : process.raw));
    return values;
}

std::vector<double> all_samples(const Timed& timed, bool of_ratios) {
    std::vector<double> values;
    for (const Process& process : timed.processes) {
        const std::vector<double>& from = of_ratios ? process.ratio : process.raw;
        values.insert(values.end(), from.begin(), from.end());
    }
    return values;
}

bool have_floor(const Timed& timed) {
    return std::all_of(timed.processes.begin(), timed.processes.end(),
                       [](const Process& process) { return !process.ratio.empty(); });
}

bool all_positive(const std::vector<double>& values) {
    return !values.empty() && std::all_of(values.begin(), values.end(), [](double v) { return v > 0.0; });
}

bool too_short(const Timed& timed, const Sides& plain) {
    return timed.name == "build" && timed.unit == "ms" && metrics::median(plain.baseline) < shortest_ms &&
           metrics::median(plain.current) < shortest_ms;
}

std::vector<double> ratios_of(const Sides& sides) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < sides.baseline.size(); ++i) ratios.push_back(sides.current[i] / sides.baseline[i]);
    return ratios;
}

void test_pairs(const Sides& sides, double margin, Line& line) {
    const std::vector<double> ratios = ratios_of(sides);
    line.ratio = metrics::median(ratios);
    line.interval = metrics::median_interval(ratios);
    std::vector<double> above, below;
    for (const double ratio : ratios) {
        above.push_back(std::log(ratio / margin));
        below.push_back(-std::log(ratio * margin));
    }
    line.p_slower = metrics::signed_rank_p(above);
    line.p_faster = metrics::signed_rank_p(below);
}

void test_apart(const Sides& sides, double margin, Line& line) {
    line.ratio = metrics::median(sides.current) / metrics::median(sides.baseline);
    line.interval = metrics::median_ratio_interval(sides.baseline, sides.current);
    std::vector<double> slowed = sides.baseline, hastened = sides.baseline;
    for (double& value : slowed) value *= margin;
    for (double& value : hastened) value /= margin;
    line.p_slower = metrics::rank_sum_p(sides.current, slowed);
    line.p_faster = metrics::rank_sum_p(hastened, sides.current);
}

void decide(double margin, Line& line) {
    if (line.interval.low > margin)
        line.verdict = Verdict::slower;
    else if (line.interval.high < 1.0 / margin)
        line.verdict = Verdict::faster;
    else if (line.interval.low >= 1.0 / margin && line.interval.high <= margin)
        line.verdict = Verdict::same;
    else
        line.verdict = Verdict::inconclusive;
}

void take_back(Line& line, std::string reason) {
    line.reason = std::move(reason);
    line.verdict = Verdict::inconclusive;
    line.p_slower = line.p_faster = 1.0;
}

// Time over floor decides nothing if the floor itself changed because other lines are read: if the plain times say the
// contrary, or are slower by more than blocks of processes and the machine account for.
void check_floor(const Sides& plain, double machine, const Options& options, Line& line) {
    const double ratio = metrics::median(plain.current) / metrics::median(plain.baseline);
    const bool decided = line.verdict == Verdict::slower || line.verdict == Verdict::faster;
    if (decided && (ratio > 1.0) != (line.verdict == Verdict::slower))
        return take_back(
            line, fmt::format("{} over its floor, but the plain time is x{:.3f}: the floor changed; run `ab` to decide",
                              to_string(line.verdict), ratio));
    if (line.verdict == Verdict::slower) return;
    const double margin = (1.0 + options.effect + plain_block_noise) * std::max(1.0, machine);
    if (metrics::median_ratio_interval(plain.baseline, plain.current).low <= margin) return;
    line.suspicious = true;
    take_back(line,
              fmt::format("looks slower: the plain time is x{:.3f}, and its floor changed with it; run `ab` to decide",
                          ratio));
}

// Blocks of processes may run in different states of the machine (another tenant on the same core makes some code 1.8
// times slower and leaves its floor unchanged).
void check_machine(double machine, double margin, Line& line) {
    if (line.verdict != Verdict::slower && line.verdict != Verdict::faster) return;
    const double state = std::max(machine, 1.0 / machine);
    if (state <= machine_state) return;
    const double needed = margin * state * worst_state;
    if (line.interval.low > needed || line.interval.high < 1.0 / needed) return;
    take_back(
        line,
        fmt::format("looks {}, but the machine was in another state: Embree's own queries took {:.2f} times as long",
                    to_string(line.verdict), machine));
}

}  // namespace

void judge_time(const Timed& baseline, const Timed& current, bool interleaved, double machine, const Options& options,
                Line& line) {
    line.time = true;
    line.measure = baseline.name;
    line.unit = baseline.unit;
    const Sides plain{medians(baseline, false), medians(current, false)};
    const bool floor = !interleaved && have_floor(baseline) && have_floor(current);
    Sides sides = floor ? Sides{medians(baseline, true), medians(current, true)} : plain;
    if (floor) line.unit = over_floor;
    line.baseline = metrics::median(sides.baseline);
    line.current = metrics::median(sides.current);
    line.processes = std::min(sides.baseline.size(), sides.current.size());
    if (baseline.unit != current.unit) {
        line.verdict = Verdict::not_comparable;
        line.reason = fmt::format("unit {} against {}", baseline.unit, current.unit);
        return;
    }
    if (!all_positive(sides.baseline) || !all_positive(sides.current)) {
        line.verdict = Verdict::not_comparable;
        line.reason = "a time is 0 and cannot be compared";
        return;
    }
    if (too_short(baseline, plain)) {
        line.reason = fmt::format("shorter than {:g} ms, too short to judge", shortest_ms);
        return;
    }
    const bool few = line.processes < fewest_processes;
    const bool paired = interleaved && sides.baseline.size() == sides.current.size();
    const double margin = 1.0 + options.effect + (paired ? 0.0 : floor ? block_noise : plain_block_noise);
    // With few processes, the repetitions still show what looks slower.
    if (few) sides = {all_samples(baseline, floor), all_samples(current, floor)};
    if (!all_positive(sides.baseline) || !all_positive(sides.current)) {
        line.verdict = Verdict::not_comparable;
        line.reason = "a time is 0 and cannot be compared";
        return;
    }
    if (paired && !few)
        test_pairs(sides, margin, line);
    else
        test_apart(sides, margin, line);
    decide(margin, line);
    line.suspicious = line.verdict == Verdict::slower;
    if (few) {
        const bool looks = line.verdict == Verdict::slower || line.verdict == Verdict::faster;
        line.reason = looks ? fmt::format("looks {}, but ", to_string(line.verdict)) : std::string();
        line.reason +=
            fmt::format("fewer than {} {} decide nothing", fewest_processes, paired ? "pairs" : "processes a side");
        line.verdict = Verdict::inconclusive;
        line.p_slower = line.p_faster = 1.0;
    } else if (line.verdict == Verdict::inconclusive) {
        line.reason = fmt::format("the interval reaches across {:.3f} or {:.3f}", 1.0 / margin, margin);
    }
    if (floor && !few) check_floor(plain, machine, options, line);
    if (!paired) check_machine(machine, margin, line);
}

std::size_t enough_processes(std::size_t times, bool interleaved, double alpha) {
    // The clearest outcome, all of one side above all of the other, is 1 of 2^n signs of pairs, or 1 of (2n over n)
    // orders.
    double p = static_cast<double>(times);
    std::size_t n = 0;
    while (p > alpha) {
        ++n;
        p *= interleaved ? 0.5 : static_cast<double>(n) / (2.0 * (2.0 * static_cast<double>(n) - 1.0));
    }
    return std::max(n, fewest_processes);
}

void apply_holm(Comparison& comparison) {
    std::vector<Line*> judged;
    std::vector<double> slower, faster;
    for (Line& line : comparison.lines) {
        if (!line.time || line.ratio == 0.0 || line.processes < fewest_processes) continue;
        judged.push_back(&line);
        slower.push_back(line.p_slower);
        faster.push_back(line.p_faster);
    }
    comparison.judged_times = judged.size();
    const std::size_t enough = enough_processes(judged.size(), comparison.interleaved, comparison.options.alpha);
    for (const Line* line : judged)
        if (line->processes < enough) comparison.enough = enough;
    slower = metrics::holm(slower);
    faster = metrics::holm(faster);
    for (std::size_t i = 0; i < judged.size(); ++i) {
        Line& line = *judged[i];
        line.p_slower = slower[i];
        line.p_faster = faster[i];
        const double p = line.verdict == Verdict::slower   ? slower[i]
                         : line.verdict == Verdict::faster ? faster[i]
                                                           : 0.0;
        if (p <= comparison.options.alpha) continue;
        line.reason =
            fmt::format("looks {}, but {} {} {} not show it beyond chance among {} times (p {:.2g} after Holm)",
                        to_string(line.verdict), line.processes, comparison.interleaved ? "pairs" : "processes a side",
                        line.processes < enough ? "can" : "do", judged.size(), p);
        line.verdict = Verdict::inconclusive;
    }
}

}  // namespace shadowbench::compare
