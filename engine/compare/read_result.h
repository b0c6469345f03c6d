// The two kinds of files. Internal to read.cpp.
#pragma once

#include "compare/measured.h"
#include "results/fields.h"

namespace shadowbench::compare {

// What result.json holds (results/report.h), as cells. Throws Error{bad_input}.
Suite read_result(const results::Field& result, const std::string& origin);

// What a program of Google Benchmark wrote with --benchmark_format=json: one process, its repetitions as samples,
// aggregates left out. Counters are taken by their names: one with "byte" or "node" in it is a size, with "error" an
// error, "instructions" is what it says, and one with "floor" and "ratio" is the ratio to the floor of that repetition;
// rates (per_second) and all others are not judged. Throws Error{bad_input}.
Suite read_kernels(const results::Field& kernels);

}  // namespace shadowbench::compare
