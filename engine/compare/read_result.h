// Readers of the two kinds of result files. Internal to read.cpp.
#pragma once

#include "compare/measured.h"
#include "results/fields.h"

namespace shadowbench::compare {

// Reads the cells of a result.json (results/report.h). Throws Error{bad_input}.
Suite read_result(const results::Field& result, const std::string& origin);

// Reads the output of a Google Benchmark program with --benchmark_format=json: one process, its repetitions as samples,
// without aggregates. The name of a counter gives its kind: with "byte" or "node" in it, a size; with "error", an
// error; "instructions", instructions; with "floor" and "ratio", the ratio to the floor of that repetition. Rates
// (per_second) and all other counters are not judged. Throws Error{bad_input}.
Suite read_kernels(const results::Field& kernels);

}  // namespace shadowbench::compare
