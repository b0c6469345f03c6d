// Two builds, in turns.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "compare/compare.h"

namespace shadowbench::service {

struct Turns {
    std::string binary_a, binary_b;      // the same twice is an A/A comparison
    std::vector<std::string> arguments;  // of both
    bool kernels = false;                // programs of Google Benchmark, not shadowbench
    int pairs = 20;
    std::string what;  // for the progress bar
};

// Runs A B, B A, A B, ...: each process leaves its result in folder/a or folder/b, and the folder is marked as
// interleaved. Throws Error: a child that fails, with its exit code and the last line it wrote.
void run_turns(const Turns& turns, const std::filesystem::path& folder, std::ostream& err);

// The results of run_turns(), compared in pairs.
compare::Comparison compare_turns(const Turns& turns, const std::filesystem::path& folder,
                                  const compare::Options& options);

// Fresh pairs of the cells that look slower, in place of the first look's verdict (compare::confirm).
void confirm_with_turns(compare::Comparison& first, Turns turns, const compare::Options& options, std::ostream& err);

}  // namespace shadowbench::service
