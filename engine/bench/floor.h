// The floor of a lookup time: reading one byte of each cache line that the lookups read, in the same order, and nothing
// else. Absolute times do not travel between machines; the ratio to this floor does better.
#pragma once

#include <span>

namespace shadowbench::bench {

// Reads the lines; the sum is returned so that the reads cannot be left out.
unsigned read_lines(std::span<const void* const> lines);

}  // namespace shadowbench::bench
