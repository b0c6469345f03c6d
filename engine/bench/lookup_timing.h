// Timed lookups: the same queries in image order and in random order, each pass with its floor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bench/maps.h"
#include "results/result.h"
#include "techniques/technique.h"

namespace shadowbench::bench {

// The queries and times of one order.
struct LookupOrder {
    std::vector<techniques::Query> queries;
    std::vector<techniques::Footprint> footprints;  // one per query, or none
    std::vector<const void*> lines;  // cache lines that the first `covered` queries read; empty: no map is read
    std::size_t covered = 0;
    int rounds = 1;  // how often a pass goes over its queries: more than once if once is too short for the clock
    std::vector<float> answers;        // of the last pass, channel after channel
    std::vector<double> ns, floor_ns;  // per lookup, one value per repetition (floor_ns: none without lines)
    results::TimedPasses passes;       // of both

    Asked asked() const { return {queries, footprints}; }
};

struct LookupPlan {
    LookupOrder image, random;
    bool warm = false;  // whether untimed passes go before each pass, so that the cache holds what fits into it
};

// The number of neighbours in a run of queries that are looked up together, and the least in a pass.
inline constexpr std::size_t run_length = 64;

// Seconds in which all queries are looked up `rounds` times on this thread; `answers` has those of the last.
double seconds_of_pass(const Maps& maps, const Asked& asked, int rounds, std::vector<float>& answers);

// Seconds of a lookup, above 0, from passes that grow until one takes a tenth of `longest` seconds, or has all queries.
double seconds_a_lookup(const Maps& maps, const Asked& asked, double longest);

// Indices of `count` of `total` queries: all, or runs of 64 neighbours spread evenly.
std::vector<std::size_t> choose_runs(std::size_t total, std::size_t count);

// The number of different random orders of `queries` lookups in one pass, if one lookup takes so long. A processor
// learns the branches of up to about 20,000 lookups if they come in the same order again and again; a deep shadow map
// then answers in random order in half the time. So a pass has more lookups than that, or takes 10 ms, which makes
// mispredicted branches negligible.
std::size_t random_orders(std::size_t queries, double seconds_a_lookup);

// Warms up, and chooses for this map how many of the queries (at most `most`, and at least 64 if there are so many)
// keep one pass at or under 10 ms. Without `floors` no lines are noted, so that only lookups are timed.
LookupPlan plan_lookups(const Maps& maps, const Asked& asked, std::size_t most, std::uint64_t seed, bool floors = true);

// Times one repetition of both orders on this thread, and appends the times to the plan. `floor_first` says whether the
// floor goes before the lookups. Alternate it, so that neither always finds the other's lines in the cache.
void time_repetition(const Maps& maps, LookupPlan& plan, bool floor_first);
// The same for one of the orders of the plan.
void time_order(const Maps& maps, const LookupPlan& plan, LookupOrder& order, bool floor_first);

results::LookupTimes summarise(const LookupOrder& order);

}  // namespace shadowbench::bench
