// The maps of one light, built from light rays of several seeds: for what a run's result does not hold, as the levels
// and the tiles of deep maps, or lookups over other footprints.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench/maps.h"
#include "bench/queries.h"
#include "bench/reference.h"
#include "claims/first_light.h"
#include "claims/paper.h"
#include "claims/turns.h"
#include "rays/capture.h"

namespace shadowbench::claims {

class SeededLight {
public:
    // The first light of scenarios/papers/<name>.json with these changes, and also with `smaller` if quick, as
    // Context::run() takes them. Notes the scenario in the report.
    SeededLight(const Context& context, const std::string& name, const std::vector<std::string>& set,
                const std::vector<std::string>& smaller);

    const rays::MapLayout& layout() const { return first_.light.layout; }
    const rays::LightView& view() const { return first_.light.view; }
    const scene::Scenario& scenario() const { return first_.scenario; }
    // The queries of the scenario's receivers.
    bench::QuerySet queries() const;
    // The truth of the scenario's reference for any queries to the light.
    bench::Truth truth(std::span<const techniques::Query> queries) const;
    // The map of every technique of the scenario, in its order. Seed 0 is the scenario's own.
    std::vector<bench::Maps> build(int seed) const;

    // Milliseconds of one thread: building the map of each technique from rays that are captured already, and last,
    // capturing them.
    Turns build_turns(std::span<const Compared> compared, const bench::RepeatRule& rule = build_rounds) const;
    std::size_t capture_place() const { return first_.contenders.size(); }  // of the capture among these turns

private:
    FirstLight first_;
    rays::Capture capture_;
};

struct TimedLookups {
    const bench::Maps* maps;
    bench::Asked asked;  // must outlive the timing
};
// Nanoseconds a lookup, on this thread. An untimed pass over the queries goes before each timed one, so that the caches
// hold of a map what fits into them, whatever was looked up before.
Turns lookup_turns(std::span<const TimedLookups> all, std::span<const Compared> compared,
                   const bench::RepeatRule& rule = lookup_rounds);

// The maps of several scenarios, for timing their lookups in turn.
class TimedMaps {
public:
    TimedMaps();
    ~TimedMaps();

    // Adds the maps of a scenario, as SeededLight takes it, in the order of its techniques. Lookups are those of its
    // receivers in image order: this many, in runs of neighbours.
    void add(const Context& context, const std::string& name, const std::vector<std::string>& set,
             const std::vector<std::string>& smaller, std::size_t lookups);

    Turns take(std::span<const Compared> compared, const bench::RepeatRule& rule = lookup_rounds) const;

private:
    struct Built;
    std::vector<std::unique_ptr<const Built>> built_;
};

}  // namespace shadowbench::claims
