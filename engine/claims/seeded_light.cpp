#include "claims/seeded_light.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "base/random.h"
#include "bench/camera_points.h"
#include "bench/clock.h"
#include "bench/lookup_timing.h"
#include "bench/shared_tile.h"
#include "rays/tracer.h"

namespace shadowbench::claims {
namespace {

constexpr double shortest_pass = 0.005;  // seconds: what interrupts a thread for a tenth of a millisecond adds 2 %

nlohmann::json noted(const Context& context, const std::string& name, const std::vector<std::string>& set,
                     const std::vector<std::string>& smaller) {
    nlohmann::json document = context.document(name, set);
    if (context.quick)
        for (const std::string& assignment : smaller) document::set_value(document, assignment);
    note_document(context, name, document);
    return document;
}

bench::QuerySet in_runs(const bench::QuerySet& all, std::size_t count) {
    return bench::pick(all.asked(), bench::choose_runs(all.queries.size(), count));
}

double nanoseconds_a_lookup(const TimedLookups& timed, std::vector<float>& answers) {
    const double warm = bench::seconds_of_pass(*timed.maps, timed.asked, 1, answers);
    const double rounds = std::clamp(std::ceil(shortest_pass / std::max(warm, 1e-9)), 1.0, 1000.0);
    const double seconds = bench::seconds_of_pass(*timed.maps, timed.asked, static_cast<int>(rounds), answers);
    return 1e9 * seconds / (rounds * static_cast<double>(timed.asked.queries.size()));
}

}  // namespace

SeededLight::SeededLight(const Context& context, const std::string& name, const std::vector<std::string>& set,
                         const std::vector<std::string>& smaller)
    : first_(noted(context, name, set, smaller), context.data),
      capture_(first_.scenario.scene, first_.light.view, first_.light.layout) {}

bench::QuerySet SeededLight::queries() const {
    const scene::Scenario& scenario = first_.scenario;
    const rays::Tracer all(scenario.scene, false);
    const std::vector<bench::CameraPoint> seen = bench::camera_points(scenario.receivers, all);
    return bench::scenario_queries(scenario, scenario.lights.front(), seen, first_.light.view);
}

bench::Truth SeededLight::truth(std::span<const techniques::Query> queries) const {
    return bench::reference_visibility(first_.scenario.scene, first_.light.view,
                                       bench::reference_settings(first_.scenario), queries, {});
}

std::vector<bench::Maps> SeededLight::build(int seed) const {
    rays::MapLayout layout = first_.light.layout;
    if (seed > 0) layout.seed = base::hash(layout.seed, static_cast<std::uint64_t>(seed));
    const rays::Capture capture(capture_, layout.seed);
    std::vector<bench::Maps> maps;
    for (const bench::Contender& contender : first_.contenders)
        maps.push_back(bench::begin_maps(*contender.row, contender.values, {layout, first_.light.view, nullptr}));
    base::parallel_for(static_cast<std::size_t>(layout.tiles()), [&](std::size_t t) {
        const rays::LightRays tile = capture.tile(static_cast<int>(t));
        bench::SharedTile shared(tile);
        for (bench::Maps& map : maps) bench::add(map, shared);
    });
    for (bench::Maps& map : maps) bench::finish(map);
    return maps;
}

Turns SeededLight::build_turns(std::span<const Compared> compared, const bench::RepeatRule& rule) const {
    const std::vector<rays::LightRays> tiles = first_.tiles();
    const base::ThreadLimit one_thread(1);
    std::vector<std::function<double()>> works;
    for (const bench::Contender& contender : first_.contenders)
        works.push_back([this, &tiles, one = &contender] {
            const bench::Stopwatch stopwatch;
            const bench::Maps maps = first_.build(*one, tiles);
            return 1e3 * stopwatch.seconds();
        });
    works.push_back([this, count = tiles.size()] {
        const bench::Stopwatch stopwatch;
        for (std::size_t t = 0; t < count; ++t) capture_.tile(static_cast<int>(t));
        return 1e3 * stopwatch.seconds();
    });
    return take_turns(works, compared, rule);
}

Turns lookup_turns(std::span<const TimedLookups> all, std::span<const Compared> compared,
                   const bench::RepeatRule& rule) {
    std::vector<float> answers;
    std::vector<std::function<double()>> passes;
    for (const TimedLookups& timed : all)
        passes.push_back([timed, &answers] { return nanoseconds_a_lookup(timed, answers); });
    return take_turns(passes, compared, rule);
}

struct TimedMaps::Built {
    Built(const Context& context, const std::string& name, const std::vector<std::string>& set,
          const std::vector<std::string>& smaller, std::size_t lookups)
        : light(context, name, set, smaller), maps(light.build(0)), asked(in_runs(light.queries(), lookups)) {}

    SeededLight light;
    std::vector<bench::Maps> maps;
    bench::QuerySet asked;
};

TimedMaps::TimedMaps() = default;
TimedMaps::~TimedMaps() = default;

void TimedMaps::add(const Context& context, const std::string& name, const std::vector<std::string>& set,
                    const std::vector<std::string>& smaller, std::size_t lookups) {
    built_.push_back(std::make_unique<const Built>(context, name, set, smaller, lookups));
}

Turns TimedMaps::take(std::span<const Compared> compared, const bench::RepeatRule& rule) const {
    std::vector<TimedLookups> all;
    for (const std::unique_ptr<const Built>& built : built_)
        for (const bench::Maps& maps : built->maps) all.push_back({&maps, built->asked.asked()});
    return lookup_turns(all, compared, rule);
}

}  // namespace shadowbench::claims
