// Times a kernel, or counts its instructions under callgrind.
#pragma once

#include "kernels/inject.h"
#include "kernels/kernel.h"

namespace benchmark {
class State;
}

namespace shadowbench::kernels {

// The number of passes in one iteration: enough for a tenth more to be at least one pass.
inline constexpr int passes = 10;

// Runs the iterations that Google Benchmark asks for, each followed by its floor outside the timed part, and sets the
// counters: those of Exact; ns_per_vertex and ns_per_lookup of a pass; floor_ratio, the time of a pass over the time of
// reading the same memory. All times are processor times. Under callgrind, it counts one iteration and dumps the count
// under the kernel's name.
void measure(benchmark::State& state, const std::string& name, const Subject& subject, const Faults& faults);

}  // namespace shadowbench::kernels
