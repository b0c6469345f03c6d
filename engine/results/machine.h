#pragma once

#include "results/result.h"

namespace shadowbench::results {

// The machine that this program runs on. The processor's name is empty where the system does not tell it.
Machine this_machine();

}  // namespace shadowbench::results
