// Text files of functions. A record is a line `n` followed by n lines `z T`; z is non-decreasing with |z| at most 1e18,
// T is non-increasing and in [0, 1], and equal z is a step. Empty lines and lines that start with # are skipped.
#pragma once

#include <filesystem>
#include <vector>

#include "curves/curve.h"

namespace shadowbench::curves {

// Throws Error: no_such_file, io, bad_input with file:line.
std::vector<Curve> read_functions(const std::filesystem::path& file);

// Writes the shortest digits that read back as the same floats, to a temporary file that is then renamed.
void write_functions(const std::filesystem::path& file, const std::vector<Curve>& functions);

}  // namespace shadowbench::curves
