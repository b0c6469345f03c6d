// A kernel on the clock, or under callgrind.
#pragma once

#include "kernels/inject.h"
#include "kernels/kernel.h"

namespace benchmark {
class State;
}

namespace shadowbench::kernels {

// One iteration is so many passes: enough of them that a tenth more is one more.
inline constexpr int passes = 10;

// Runs the iterations that Google Benchmark asks for, each followed by its floor off the clock, and sets the counters:
// those of Exact; ns_per_vertex and ns_per_lookup of a pass; floor_ratio, the time of a pass over that of reading what
// it reads. All three in processor time. Under callgrind it counts one iteration alone and dumps the count under the
// kernel's name.
void measure(benchmark::State& state, const std::string& name, const Subject& subject, const Faults& faults);

}  // namespace shadowbench::kernels
