// The maps of one light, built from light rays of several seeds: for what a run's result does not hold, as the levels
// and the tiles of deep maps, or lookups over other footprints.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench/contender.h"
#include "bench/load.h"
#include "bench/maps.h"
#include "bench/prepared_light.h"
#include "bench/queries.h"
#include "claims/paper.h"
#include "claims/value.h"
#include "rays/capture.h"

namespace shadowbench::claims {

class SeededLight {
public:
    // The first light of scenarios/papers/<name>.json with these changes, and also with `smaller` if quick, as
    // Context::run() takes them. Notes the scenario in the report.
    SeededLight(const Context& context, const std::string& name, const std::vector<std::string>& set,
                const std::vector<std::string>& smaller);
    SeededLight(const SeededLight&) = delete;
    SeededLight& operator=(const SeededLight&) = delete;

    const rays::MapLayout& layout() const { return light_.layout; }
    // The queries of the scenario's receivers.
    bench::QuerySet queries() const;
    // The map of every technique of the scenario, in its order. Seed 0 is the scenario's own.
    std::vector<bench::Maps> build(int seed) const;

private:
    bench::ScenarioLoader loader_;
    const scene::Scenario* scenario_ = nullptr;
    std::vector<bench::Contender> contenders_;
    bench::PreparedLight light_;
    std::unique_ptr<rays::Capture> capture_;
};

struct TimedLookups {
    const bench::Maps* maps;
    bench::Asked asked;  // must outlive the timing
};
// Nanoseconds a lookup, on this thread: medians of passes over all queries, after one untimed pass. The passes of all
// go in turn, so that a disturbance hits all alike.
std::vector<Value> lookup_times(std::span<const TimedLookups> all);

}  // namespace shadowbench::claims
