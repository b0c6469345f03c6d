// What the scheduler and the host of a virtual machine take from the timed thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "results/result.h"

namespace shadowbench::bench {

// How often the scheduler took the processor from this thread since it started, although it could have gone on.
std::uint64_t involuntary_switches();

// Counts a pass during which that happened `switches` times.
void count_pass(std::uint64_t switches, results::TimedPasses& passes);

// The ticks that the host took from all processors since the system started: the eighth number of the line "cpu" of
// /proc/stat. Absent if the text has no such number.
std::optional<std::uint64_t> read_steal(std::string_view stat);

// The same in seconds, of this machine; absent where /proc/stat does not tell it.
std::optional<double> steal_seconds();

}  // namespace shadowbench::bench
