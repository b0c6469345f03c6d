// Runs two builds in turns and compares their results.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "compare/compare.h"

namespace shadowbench::service {

struct Turns {
    std::string binary_a, binary_b;      // the same build twice: an A/A comparison
    std::vector<std::string> arguments;  // of both builds
    bool kernels = false;                // the programs use Google Benchmark; they are not shadowbench
    int pairs = 20;
    std::string what;  // title in the progress bar
};

// Runs A B, B A, A B, ... Each process leaves its result in folder/a or folder/b, and the folder is marked as
// interleaved. Throws Error for a process that fails, with its exit code and the last line that it wrote.
void run_turns(const Turns& turns, const std::filesystem::path& folder, std::ostream& err);

// Compares the results of run_turns() in pairs.
compare::Comparison compare_turns(const Turns& turns, const std::filesystem::path& folder,
                                  const compare::Options& options);

// Runs new pairs of the cells that look slower. Their verdicts replace those of `first` (compare::confirm).
void confirm_with_turns(compare::Comparison& first, Turns turns, const compare::Options& options, std::ostream& err);

}  // namespace shadowbench::service
