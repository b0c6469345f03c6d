#include "bench/build_timing.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "bench/clock.h"
#include "bench/disturbance.h"
#include "bench/shared_tile.h"

namespace shadowbench::bench {
namespace {

// The time of a part of a build, and how often it was interrupted.
struct Spent {
    double seconds = 0.0;
    std::uint64_t switches = 0;

    void add(const Spent& more) {
        seconds += more.seconds;
        switches += more.switches;
    }
};

struct TimedBuild {
    std::size_t contender;
    Maps maps;
    Spent spent = {};
};

template <typename Part>
Spent time_part(const Part& part) {
    const std::uint64_t before = involuntary_switches();
    const Stopwatch stopwatch;
    part();
    const double seconds = stopwatch.seconds();
    return {seconds, involuntary_switches() - before};
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
    attempt(contender, [&] {
        build.spent.add(time_part([&] { build.maps = begin_maps(*contender.row, contender.values, input); }));
    });
    return build;
}

// Functions and means are made and timed once, and each build that reads them is charged their time.
void add_timed(std::span<TimedBuild> builds, std::span<Contender> contenders, const rays::LightRays& rays) {
    SharedTile tile(rays);
    std::array<std::optional<Spent>, 3> functions, means;  // of each channel
    const auto charge = [](TimedBuild& build, std::optional<Spent>& spent, const auto& make) {
        if (!spent) spent = time_part(make);
        build.spent.add(*spent);
    };
    for (TimedBuild& build : builds)
        attempt(contenders[build.contender], [&] {
            for (std::size_t p = 0; p < build.maps.parts.size(); ++p) {
                prepare_part(build.maps, p, tile);
                if (reads_functions(build.maps, rays)) charge(build, functions[p], [&] { tile.functions(p); });
                if (reads_means(build.maps, rays)) charge(build, means[p], [&] { tile.means(p); });
                build.spent.add(time_part([&] { add_part(build.maps, p, tile); }));
            }
        });
}

void finish_timed(TimedBuild& build, Contender& contender, std::vector<std::vector<double>>& seconds,
                  results::TimedPasses& passes) {
    attempt(contender, [&] {
        build.spent.add(time_part([&] { finish(build.maps); }));
        seconds[build.contender].push_back(build.spent.seconds);
        count_pass(build.spent.switches, passes);
    });
    build.maps = {};
}

// The contenders of an apron whose maps grow together, in order: those that share functions or means of the same rays,
// or all if each pass over the rays captures them again; but no more than `room` bytes hold.
std::vector<std::vector<std::size_t>> groups_of(std::span<const Contender> contenders, int apron, bool kept,
                                                const rays::MapLayout& layout, std::size_t room) {
    std::vector<std::vector<std::size_t>> groups;
    std::optional<std::size_t> shared;
    std::size_t left = 0;  // of the room, beside the shared group
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        if (!contenders[i].ok() || contenders[i].needs.apron != apron) continue;
        const bool together = !kept || shares(contenders[i].needs, layout);
        const std::size_t bytes = contenders[i].cell.working_bytes;
        const bool joins = together && shared && bytes <= left;
        if (!joins) groups.emplace_back();
        if (together && !joins) {
            shared = groups.size() - 1;
            left = room;
        }
        if (together) left -= std::min(left, bytes);
        (joins ? groups[*shared] : groups.back()).push_back(i);
    }
    return groups;
}

}  // namespace

void time_builds(std::span<Contender> contenders, const RaySource& source, const techniques::BuildInput& input,
                 std::vector<std::vector<double>>& seconds, results::TimedPasses& passes, std::size_t room) {
    for (const int apron : aprons_of(contenders))
        for (const std::vector<std::size_t>& group :
             groups_of(contenders, apron, source.kept(apron), input.layout, room)) {
            std::vector<TimedBuild> builds;
            for (const std::size_t i : group) builds.push_back(begin_timed(contenders, i, input));
            source.for_each_batch(apron, [&](RaySource::Batch batch) {
                for (const rays::LightRays& tile : batch) add_timed(builds, contenders, tile);
            });
            for (TimedBuild& build : builds) finish_timed(build, contenders[build.contender], seconds, passes);
        }
}

}  // namespace shadowbench::bench
