#include "bench/build_timing.h"

#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "bench/clock.h"
#include "bench/disturbance.h"

namespace shadowbench::bench {
namespace {

struct TimedBuild {
    std::size_t contender;
    Maps maps;
    double seconds = 0.0;
    std::uint64_t switches = 0;
};

// Adds the time of a part of a build, and how often it was interrupted.
template <typename Part>
void time_part(TimedBuild& build, const Part& part) {
    const std::uint64_t before = involuntary_switches();
    const Stopwatch stopwatch;
    part();
    build.seconds += stopwatch.seconds();
    build.switches += involuntary_switches() - before;
}

// Makes a step of the build of a contender that is ok; one that throws fails.
template <typename Step>
void attempt(Contender& contender, const Step& step) {
    if (!contender.ok()) return;
    const base::ThreadLimit one_thread(1);
    try {
        step();
    } catch (const base::Error& error) {
        if (error.code() != base::ErrorCode::internal) throw;
        fail(contender, "building the map once more: " + error.message());
    }
}

TimedBuild begin_timed(std::span<Contender> contenders, std::size_t i, const techniques::BuildInput& input) {
    TimedBuild build{i, {}};
    Contender& contender = contenders[i];
    attempt(contender,
            [&] { time_part(build, [&] { build.maps = begin_maps(*contender.row, contender.values, input); }); });
    return build;
}

void add_timed(TimedBuild& build, Contender& contender, RaySource::Batch batch) {
    attempt(contender, [&] {
        for (const rays::LightRays& tile : batch) {
            const std::size_t parts = build.maps.parts.size();
            for (std::size_t p = 0; p < parts; ++p) {
                rays::LightRays single;
                if (parts > 1) single = rays::channel(tile, static_cast<int>(p));
                time_part(build, [&] { build.maps.parts[p]->add(parts > 1 ? single : tile); });
            }
        }
    });
}

void finish_timed(TimedBuild& build, Contender& contender, std::vector<std::vector<double>>& seconds,
                  results::TimedPasses& passes) {
    attempt(contender, [&] {
        time_part(build, [&] { finish(build.maps); });
        seconds[build.contender].push_back(build.seconds);
        count_pass(build.switches, passes);
    });
}

}  // namespace

void time_builds(std::span<Contender> contenders, const RaySource& source, const techniques::BuildInput& input,
                 std::vector<std::vector<double>>& seconds, results::TimedPasses& passes) {
    for (const int apron : aprons_of(contenders)) {
        std::vector<TimedBuild> builds;  // those that grow together if each pass captures the rays again
        for (std::size_t i = 0; i < contenders.size(); ++i) {
            if (!contenders[i].ok() || contenders[i].needs.apron != apron) continue;
            TimedBuild build = begin_timed(contenders, i, input);
            if (!source.kept(apron)) {
                builds.push_back(std::move(build));
                continue;
            }
            source.for_each_batch(apron, [&](RaySource::Batch batch) { add_timed(build, contenders[i], batch); });
            finish_timed(build, contenders[i], seconds, passes);
        }
        if (builds.empty()) continue;
        source.for_each_batch(apron, [&](RaySource::Batch batch) {
            for (TimedBuild& build : builds) add_timed(build, contenders[build.contender], batch);
        });
        for (TimedBuild& build : builds) finish_timed(build, contenders[build.contender], seconds, passes);
    }
}

}  // namespace shadowbench::bench
