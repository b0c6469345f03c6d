#include "bench/build_timing.h"

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
        if (tile.channels == 1) {
            const Stopwatch stopwatch;
            build.maps.channel[0]->add(tile);
            build.seconds += stopwatch.seconds();
            continue;
        }
        for (int c = 0; c < tile.channels; ++c) {
            const rays::LightRays one = rays::channel(tile, c);
            const Stopwatch stopwatch;
            build.maps.channel[static_cast<std::size_t>(c)]->add(one);
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
    if (source.kept()) {
        for (std::size_t i = 0; i < contenders.size(); ++i) {
            if (!contenders[i].ok()) continue;
            TimedBuild build = begin_timed(contenders, i, input);
            source.for_each_batch([&](RaySource::Batch batch) { add_timed(build, batch); });
            finish_timed(build, seconds);
        }
        return;
    }
    std::vector<TimedBuild> builds;
    for (std::size_t i = 0; i < contenders.size(); ++i)
        if (contenders[i].ok()) builds.push_back(begin_timed(contenders, i, input));
    source.for_each_batch([&](RaySource::Batch batch) {
        for (TimedBuild& build : builds) add_timed(build, batch);
    });
    for (TimedBuild& build : builds) finish_timed(build, seconds);
}

}  // namespace shadowbench::bench
