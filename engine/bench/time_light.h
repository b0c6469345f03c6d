// Times the builds and lookups of all techniques on one light.
#pragma once

#include <span>

#include "bench/contender.h"
#include "bench/light_run.h"
#include "bench/queries.h"
#include "bench/ray_source.h"

namespace shadowbench::bench {

// Sets the times of every cell that is ok; one that gives an invalid answer at one of the timed receivers fails. A
// round builds all maps, then looks up in all, or does only one of the two: see RepeatRule. Builds before all lookups
// would take a second on a small scene, all of it in one state of the machine, such as a busy sibling core; their
// intervals would be narrow, and wrong by that state.
results::TimingReport time_light(const LightJob& job, std::span<Contender> contenders, const RaySource& source,
                                 const techniques::BuildInput& input, const Asked& asked);

}  // namespace shadowbench::bench
