// A finished run as an exploration: its rows are settings that were measured and confirmed, so that it can be asked for
// the cheapest of them.
#pragma once

#include <string>

#include "recommend/recommendation.h"
#include "results/result.h"

namespace shadowbench::recommend {

// Every row of the light is a family of one setting. Its error has the interval over the seeds that the run measured
// (reference.spread_seeds); rays that are not random have the same error with every seed. Its build includes capturing
// the light rays on one thread, at the speed that the run measured on a sample of them.
//
// `light`: a name, or a number from 0 on; empty: the only light. Throws Error{usage}, place "--light", for a light that
// does not exist or is not chosen; Error{bad_input}, place `origin`, for a run whose rows do not answer one question:
// it sweeps something else than resolution and samples, sweeps the resolution while footprints are in map pixels, was
// measured with one seed of random rays, or `measure` is the curve error, which a run measures with one seed.
Recommendation recommendation_of(const results::Result& run, const std::string& light, Measure measure,
                                 const std::string& origin);

}  // namespace shadowbench::recommend
