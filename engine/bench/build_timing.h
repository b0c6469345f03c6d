// Builds against the clock, on one thread.
#pragma once

#include <span>
#include <vector>

#include "bench/contender.h"
#include "bench/ray_source.h"

namespace shadowbench::bench {

// One full build of every contender that is ok, in order; seconds of each are appended to seconds[i]. Capturing and
// splitting colours into channels are not part of the time. Maps are dropped at once when the light rays are kept; else
// all of them grow together, since each pass captures anew.
void time_builds(std::span<const Contender> contenders, const RaySource& source, const techniques::BuildInput& input,
                 std::vector<std::vector<double>>& seconds);

}  // namespace shadowbench::bench
