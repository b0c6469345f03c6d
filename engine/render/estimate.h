// Estimates how long the pictures of a scenario will take: see bench/estimate.h.
#pragma once

#include "bench/work.h"

namespace shadowbench::render {

// Seconds for loading a variant, rendering it with usual_options() and writing its pictures. A deep image has none.
double estimate_pictures(const bench::VariantWork& variant, int threads);

}  // namespace shadowbench::render
