// Text files of functions: records of a line `n` followed by n lines `z T`; z non-decreasing, T non-increasing and in
// [0, 1], |z| at most 1e18, equal z is a step. Empty lines and lines that start with # are skipped.
#pragma once

#include <filesystem>
#include <vector>

#include "curves/curve.h"

namespace shadowbench::curves {

// Throws Error: no_such_file, io, bad_input with file:line.
std::vector<Curve> read_functions(const std::filesystem::path& file);

// Shortest digits that read back as the same floats. Written to a temporary name, then renamed.
void write_functions(const std::filesystem::path& file, const std::vector<Curve>& functions);

}  // namespace shadowbench::curves
