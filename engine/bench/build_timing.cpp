#include "bench/build_timing.h"

#include <utility>

#include "base/parallel.h"
#include "bench/clock.h"

namespace shadowbench::bench {
namespace {

struct TimedBuild {
    std::size_t contender;
    Maps maps;
    double seconds = 0.0;
};

TimedBuild begin_timed(std::span<const Contender> contenders, std::size_t i, const techniques::BuildInput& input) {
    const base::ThreadLimit one_thread(1);
    const Stopwatch stopwatch;
    TimedBuild build{i, begin_maps(*contenders[i].row, contenders[i].values, input)};
    build.seconds = stopwatch.seconds();
    return build;
}

void add_timed(TimedBuild& build, RaySource::Batch batch) {
    const base::ThreadLimit one_thread(1);
    for (const rays::LightRays& tile : batch) {
        const std::size_t parts = build.maps.parts.size();
        for (std::size_t p = 0; p < parts; ++p) {
            rays::LightRays single;
            if (parts > 1) single = rays::channel(tile, static_cast<int>(p));
            const Stopwatch stopwatch;
            build.maps.parts[p]->add(parts > 1 ? single : tile);
            build.seconds += stopwatch.seconds();
        }
    }
}

void finish_timed(TimedBuild& build, std::vector<std::vector<double>>& seconds) {
    const base::ThreadLimit one_thread(1);
    const Stopwatch stopwatch;
    finish(build.maps);
    seconds[build.contender].push_back(build.seconds + stopwatch.seconds());
}

}  // namespace

void time_builds(std::span<const Contender> contenders, const RaySource& source, const techniques::BuildInput& input,
                 std::vector<std::vector<double>>& seconds) {
    for (const int apron : aprons_of(contenders)) {
        std::vector<TimedBuild> builds;  // those that grow together if each pass captures the rays again
        for (std::size_t i = 0; i < contenders.size(); ++i) {
            if (!contenders[i].ok() || contenders[i].needs.apron != apron) continue;
            TimedBuild build = begin_timed(contenders, i, input);
            if (!source.kept(apron)) {
                builds.push_back(std::move(build));
                continue;
            }
            source.for_each_batch(apron, [&](RaySource::Batch batch) { add_timed(build, batch); });
            finish_timed(build, seconds);
        }
        if (builds.empty()) continue;
        source.for_each_batch(apron, [&](RaySource::Batch batch) {
            for (TimedBuild& build : builds) add_timed(build, batch);
        });
        for (TimedBuild& build : builds) finish_timed(build, seconds);
    }
}

}  // namespace shadowbench::bench
