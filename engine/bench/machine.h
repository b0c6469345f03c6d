#pragma once

#include "bench/result.h"

namespace shadowbench::bench {

// The machine that this program runs on. The processor's name is empty where the system does not tell it.
Machine this_machine();

}  // namespace shadowbench::bench
