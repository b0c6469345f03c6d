// Timed builds, on one thread.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "bench/contender.h"
#include "bench/ray_source.h"
#include "results/result.h"

namespace shadowbench::bench {

// Builds every contender that is ok once, appends the seconds of each to seconds[i], and counts its pass. Capturing and
// splitting colours into channels are not timed.
//
// Maps that read the means of a pixel's rays, or the functions of its rays in media, grow together, tile by tile: these
// are made once, and their time is added to that of each map that reads them, as if it had made them itself. A map that
// is built by itself is timed in the same parts. Of the others, each map is dropped before the next one begins if the
// light rays are kept; otherwise all maps grow together, since each pass captures the rays again. No more maps grow
// together than `room` bytes hold, by the working bytes in their cells; but one always does. A technique that throws
// Error{internal}, though it could build this map before, fails.
void time_builds(std::span<Contender> contenders, const RaySource& source, const techniques::BuildInput& input,
                 std::vector<std::vector<double>>& seconds, results::TimedPasses& passes,
                 std::size_t room = std::numeric_limits<std::size_t>::max());

}  // namespace shadowbench::bench
