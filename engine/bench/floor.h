// The floor of a lookup time: the time to read one byte of each cache line that the lookups read, in the same order,
// and nothing else. Ratios to this floor carry over between machines better than absolute times.
#pragma once

#include <span>

namespace shadowbench::bench {

// Reads the lines. Returns the sum of the bytes, so that the compiler cannot remove the reads.
unsigned read_lines(std::span<const void* const> lines);

}  // namespace shadowbench::bench
