// Times the builds and lookups of all techniques on one light.
#pragma once

#include <span>

#include "bench/contender.h"
#include "bench/light_run.h"
#include "bench/queries.h"
#include "bench/ray_source.h"

namespace shadowbench::bench {

// Rounds of builds, then rounds of lookups: see RepeatRule. Sets the times of every cell that is ok; one that gives an
// invalid answer at one of the timed receivers fails. Further rounds of builds may take half of timing.seconds, those
// of lookups what is left.
results::TimingReport time_light(const LightJob& job, std::span<Contender> contenders, const RaySource& source,
                                 const techniques::BuildInput& input, const Asked& asked);

}  // namespace shadowbench::bench
