#include "kernels/measure.h"

#include <time.h>

#include <algorithm>
#include <cmath>

#include <benchmark/benchmark.h>

#include "kernels/callgrind.h"

namespace shadowbench::kernels {
namespace {

constexpr double least_floor = 100e-6;  // seconds of one reading of the floor: keeps clock errors below 0.1 %
constexpr int most_rounds = 10000;

// Processor time of this thread, which does all the work: time that other programs take of a shared processor does not
// count.
double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds_of_floor(const Subject& subject, int rounds) {
    unsigned sum = 0;
    const double start = processor_seconds();
    for (int r = 0; r < rounds; ++r) sum += subject.floor();
    const double end = processor_seconds();
    benchmark::DoNotOptimize(sum);
    return end - start;
}

int rounds_of_floor(const Subject& subject) {
    if (!subject.floor) return 0;
    seconds_of_floor(subject, 1);
    const double once = seconds_of_floor(subject, 1);
    return static_cast<int>(std::clamp(std::ceil(least_floor / std::max(once, 1e-9)), 1.0, double{most_rounds}));
}

// The number of passes in an iteration: a slow kernel makes more, so that the given share is reached over many
// iterations.
class Passes {
public:
    explicit Passes(double slow) : wanted_(passes * (1.0 + slow)) {}
    int next() {
        owed_ += wanted_;
        const int now = static_cast<int>(std::lround(owed_));
        owed_ -= now;
        return now;
    }

private:
    double wanted_, owed_ = 0.0;
};

void count(const std::string& name, const Subject& subject, int times) {
    subject.pass();  // not counted: only the first pass grows scratch memory
    callgrind::start();
    for (int p = 0; p < times; ++p) subject.pass();
    callgrind::stop(name);
}

void set(benchmark::State& state, const char* name, std::optional<double> value) {
    if (value) state.counters[name] = *value;
}

}  // namespace

void measure(benchmark::State& state, const std::string& name, const Subject& subject, const Faults& faults) {
    const bool counting = callgrind::running();
    const int rounds = counting ? 0 : rounds_of_floor(subject);
    Passes passes_of(faults.slow);
    double seconds = 0.0, floor_seconds = 0.0;
    for ([[maybe_unused]] auto iteration : state) {
        const int times = passes_of.next();
        if (counting) {
            count(name, subject, times);
            continue;
        }
        const double start = processor_seconds();
        for (int p = 0; p < times; ++p) subject.pass();
        seconds += processor_seconds() - start;
        if (rounds == 0) continue;
        state.PauseTiming();
        floor_seconds += seconds_of_floor(subject, rounds);
        state.ResumeTiming();
    }
    const Exact exact = with(subject.exact, faults);
    set(state, "bytes", exact.bytes);
    set(state, "nodes", exact.nodes);
    set(state, "error", exact.error);
    set(state, "lookup_error", exact.lookup_error);
    if (counting) return;
    // An extra pass of a slow kernel adds time, but no vertices or lookups.
    const double pass = seconds / (static_cast<double>(state.iterations()) * passes);
    if (subject.vertices > 0.0) state.counters["ns_per_vertex"] = 1e9 * pass / subject.vertices;
    if (subject.lookups > 0.0) state.counters["ns_per_lookup"] = 1e9 * pass / subject.lookups;
    if (rounds == 0) return;
    const double floor = floor_seconds / (static_cast<double>(state.iterations()) * rounds) / subject.floor_share;
    state.counters["floor_ratio"] = pass / floor;
}

}  // namespace shadowbench::kernels
