#include "bench/lookup_timing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/random.h"
#include "bench/clock.h"
#include "bench/disturbance.h"
#include "bench/floor.h"
#include "bench/queries.h"

namespace shadowbench::bench {
namespace {

constexpr double longest_pass = 0.010;         // seconds
constexpr double longest_warm_pass = 0.100;    // seconds: only passes of 64 lookups that take longer stay cold
constexpr double longest_random_pass = 0.010;  // seconds, of several random orders
constexpr double beyond_prediction = 65536.0;  // number of lookups beyond what a branch predictor learns
constexpr int least_warm_passes = 2, most_warm_passes = 16;
constexpr double warm_time = 0.025;      // seconds: a map of the size of L3 needs several passes to fill it
constexpr double no_faster = 0.99;       // of the fastest pass before: the caches have settled if two in a row are so
constexpr double shortest_pass = 0.002;  // seconds: keeps clock errors and late interrupts below 1 %
constexpr std::size_t most_lines = std::size_t{1} << 21;  // 16 MiB of addresses an order

// Stores the floor's sum, so that the compiler cannot remove it.
void consume(unsigned value) {
    volatile unsigned sink = value;
    static_cast<void>(sink);
}

double seconds_of_floor(std::span<const void* const> lines, int rounds) {
    unsigned sum = 0;
    const Stopwatch stopwatch;
    for (int r = 0; r < rounds; ++r) sum += read_lines(lines);
    const double seconds = stopwatch.seconds();
    consume(sum);
    return seconds;
}

// Appends all queries in a random order.
void append_shuffled(const LookupOrder& all, base::Random& random, LookupOrder& to) {
    const std::size_t first = to.queries.size(), count = all.queries.size();
    to.queries.insert(to.queries.end(), all.queries.begin(), all.queries.end());
    to.footprints.insert(to.footprints.end(), all.footprints.begin(), all.footprints.end());
    for (std::size_t i = count; i > 1; --i) {
        const std::size_t a = first + i - 1, b = first + random.below(i);
        std::swap(to.queries[a], to.queries[b]);
        if (!to.footprints.empty()) std::swap(to.footprints[a], to.footprints[b]);
    }
}

int rounds_of(double seconds_a_round) {
    if (seconds_a_round >= shortest_pass) return 1;
    return static_cast<int>(std::min(1000.0, std::ceil(shortest_pass / seconds_a_round)));
}

// Makes untimed passes until the caches have settled: at least two, then more until passes get no faster, at most for
// `time` seconds.
template <typename Pass>
void warm_up(double time, const Pass& pass) {
    double seconds = 0.0, fastest = std::numeric_limits<double>::infinity();
    int steady = 0;
    for (int p = 0; p < least_warm_passes || (p < most_warm_passes && seconds < time && steady < 2); ++p) {
        const double last = pass();
        steady = last > no_faster * fastest ? steady + 1 : 0;
        fastest = std::min(fastest, last);
        seconds += last;
    }
}

// The seconds of a timed pass, which is counted.
template <typename Pass>
double counted(results::TimedPasses& passes, const Pass& pass) {
    const std::uint64_t before = involuntary_switches();
    const double seconds = pass();
    count_pass(involuntary_switches() - before, passes);
    return seconds;
}

}  // namespace

double seconds_of_pass(const Maps& maps, const Asked& asked, int rounds, std::vector<float>& out) {
    out.resize(asked.queries.size() * maps.channels());
    const Stopwatch stopwatch;
    for (int r = 0; r < rounds; ++r) lookup(maps, asked, out);
    return stopwatch.seconds();
}

double seconds_a_lookup(const Maps& maps, const Asked& asked, double longest) {
    std::vector<float> out;
    const std::size_t all = asked.queries.size();
    std::size_t count = std::min(run_length, all);
    for (;;) {
        const QuerySet some = pick(asked, choose_runs(all, count));
        const double seconds = seconds_of_pass(maps, some.asked(), 1, out);
        if (seconds > 0.1 * longest || count == all) return std::max(seconds, 1e-9) / static_cast<double>(count);
        count = std::min(4 * count, all);
    }
}

std::vector<std::size_t> choose_runs(std::size_t total, std::size_t count) {
    std::vector<std::size_t> chosen;
    count = std::min(count, total);
    if (count == 0) return chosen;
    // Whole runs of the sequence, numbered; the chosen ones are spread evenly.
    const std::size_t runs = (total + run_length - 1) / run_length;
    const std::size_t wanted = (count + run_length - 1) / run_length;
    for (std::size_t r = 0; r < wanted; ++r) {
        const std::size_t first = r * runs / wanted * run_length;
        for (std::size_t i = first; i < std::min(first + run_length, total) && chosen.size() < count; ++i)
            chosen.push_back(i);
    }
    return chosen;
}

std::size_t random_orders(std::size_t queries, double seconds_a_lookup) {
    const double count = static_cast<double>(std::max<std::size_t>(queries, 1));
    const double enough = std::ceil(beyond_prediction / count), fit = longest_random_pass / (seconds_a_lookup * count);
    return static_cast<std::size_t>(std::clamp(fit, 1.0, std::max(enough, 1.0)));
}

LookupPlan plan_lookups(const Maps& maps, const Asked& asked, std::size_t most, std::uint64_t seed, bool floors) {
    const double lookup_seconds = seconds_a_lookup(maps, asked, longest_pass);
    const double fit = longest_pass / lookup_seconds;
    const std::size_t count =
        std::clamp(static_cast<std::size_t>(std::min(fit, 1e15)), run_length, std::max(most, run_length));

    LookupPlan plan;
    QuerySet chosen = pick(asked, choose_runs(asked.queries.size(), count));
    plan.image.queries = std::move(chosen.queries);
    plan.image.footprints = std::move(chosen.footprints);
    base::Random random(base::hash(seed));
    const std::size_t orders = random_orders(plan.image.queries.size(), lookup_seconds);
    for (std::size_t o = 0; o < orders; ++o) append_shuffled(plan.image, random, plan.random);
    for (LookupOrder* order : {&plan.image, &plan.random}) {
        if (floors) order->covered = touched(maps, order->asked(), most_lines, order->lines);
        order->lines.shrink_to_fit();
        order->rounds = rounds_of(lookup_seconds * static_cast<double>(order->queries.size()));
    }
    plan.warm = lookup_seconds * static_cast<double>(plan.image.queries.size()) < longest_warm_pass;
    return plan;
}

namespace {

// `settled`: what was timed last read the same lines, so the cache holds those of the map that it can hold.
void time_order(const Maps& maps, const LookupPlan& plan, LookupOrder& order, bool floor_first, bool settled) {
    const int rounds = order.rounds;
    const double lookups = static_cast<double>(order.queries.size()) * rounds;
    const double read = static_cast<double>(order.covered) * rounds;
    const double settling = settled ? 0.0 : warm_time;
    const auto warm_floor = [&](double time) { warm_up(time, [&] { return seconds_of_floor(order.lines, 1); }); };
    // Lookups and floor each warm up, so that what ran before has no influence.
    const auto time_lookups = [&] {
        // The floor's reads leave lines in the cache that lookups do not. Reading them here makes the order of the two
        // irrelevant.
        if (plan.warm && !order.lines.empty()) warm_floor(0.0);
        if (plan.warm) warm_up(settling, [&] { return seconds_of_pass(maps, order.asked(), 1, order.answers); });
        const double seconds =
            counted(order.passes, [&] { return seconds_of_pass(maps, order.asked(), rounds, order.answers); });
        order.ns.push_back(1e9 * seconds / lookups);
    };
    const auto time_floor = [&] {
        if (order.lines.empty()) return;
        if (plan.warm) warm_floor(floor_first ? settling : 0.0);
        const double seconds = counted(order.passes, [&] { return seconds_of_floor(order.lines, rounds); });
        order.floor_ns.push_back(1e9 * seconds / read);
    };
    if (floor_first) time_floor();
    time_lookups();
    if (!floor_first) time_floor();
}

}  // namespace

void time_order(const Maps& maps, const LookupPlan& plan, LookupOrder& order, bool floor_first) {
    time_order(maps, plan, order, floor_first, false);
}

void time_repetition(const Maps& maps, LookupPlan& plan, bool floor_first) {
    time_order(maps, plan, plan.image, floor_first, false);
    time_order(maps, plan, plan.random, floor_first, true);
}

results::LookupTimes summarise(const LookupOrder& order) {
    results::LookupTimes times;
    times.ns = results::summarise(order.ns);
    if (order.floor_ns.empty()) return times;
    times.floor = results::summarise(order.floor_ns);
    std::vector<double> ratios;
    for (std::size_t r = 0; r < order.ns.size(); ++r) ratios.push_back(order.ns[r] / order.floor_ns[r]);
    times.ratio = results::summarise(std::move(ratios));
    return times;
}

}  // namespace shadowbench::bench
