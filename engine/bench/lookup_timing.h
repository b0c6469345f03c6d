// Lookups against the clock: the same queries in image order and in random order, each pass beside its floor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bench/maps.h"
#include "results/result.h"
#include "techniques/technique.h"

namespace shadowbench::bench {

// What one timed pass in one order looks up.
struct LookupOrder {
    std::vector<techniques::Query> queries;
    std::vector<techniques::Footprint> footprints;  // one a query, or none
    std::vector<const void*> lines;  // that the first `covered` of the queries read; empty: no map is read
    std::size_t covered = 0;
    int rounds = 1;  // a pass goes over its queries so often: more than once when once is too short for the clock
    std::vector<float> answers;        // of the last pass, channel after channel
    std::vector<double> ns, floor_ns;  // a lookup; one of each a repetition (floor_ns: none without lines)

    Asked asked() const { return {queries, footprints}; }
};

struct LookupPlan {
    LookupOrder image, random;
    bool warm = false;  // each pass follows untimed ones of its kind, so that it finds in the cache what fits into it
};

// Indices of `count` of `total` queries: all, or runs of 64 neighbours spread evenly.
std::vector<std::size_t> choose_runs(std::size_t total, std::size_t count);

// How many different random orders of `queries` lookups follow one another in a pass, when one lookup takes so long. A
// processor learns the branches of up to some 20,000 lookups by heart when they come in the same order again and again,
// and then a deep shadow map answers in random order in half the time; so that a pass holds more than that, or takes
// 10 ms, beside which mispredicted branches are small.
std::size_t random_orders(std::size_t queries, double seconds_a_lookup);

// Warms up, and chooses for this map how many of the queries (at most `most`, at least 64 where there are so many) keep
// one pass at or under 50 ms.
LookupPlan plan_lookups(const Maps& maps, const Asked& asked, std::size_t most, std::uint64_t seed);

// One repetition of both orders on this thread, appended to the plan's times. `floor_first` says which of a lookup and
// its floor goes first: alternate it, so that neither always finds the other's lines in the cache.
void time_repetition(const Maps& maps, LookupPlan& plan, bool floor_first);

results::LookupTimes summarise(const LookupOrder& order);

}  // namespace shadowbench::bench
