// The processor and core count that a result records.
#pragma once

#include "results/result.h"

namespace shadowbench::results {

// The machine that runs this program. `cpu` is empty if /proc/cpuinfo does not name the processor.
Machine this_machine();

}  // namespace shadowbench::results
