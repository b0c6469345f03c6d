// Short timings of lookups, for searches over many maps: a few passes, without a floor. What a search settles on is
// timed as a run does (lookup_timing.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bench/maps.h"
#include "results/result.h"

namespace shadowbench::bench {

struct QuickTimes {
    results::Sample image_ns, random_ns;   // per lookup, one thread
    std::size_t lookups = 0;               // in one pass in image order
    std::vector<float> answers;            // of the last pass in image order, channel after channel
    std::vector<techniques::Query> asked;  // its queries
};

// Looks up at most `most` of the queries, fewer if they take long, on this thread: each order once untimed, then three
// times.
QuickTimes quick_lookup_times(const Maps& maps, const Asked& asked, std::size_t most, std::uint64_t seed);

}  // namespace shadowbench::bench
