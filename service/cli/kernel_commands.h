// The commands that run kernels and write the baseline, with their parsed arguments. Each throws base::Error.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace shadowbench::service {

constexpr int wrong_answer = 2;  // exit code of the kernel program: a kernel computed a wrong result

struct InstructionArguments {
    std::string kernels;                 // the program; empty: "kernels" beside this program
    std::string filter;                  // regular expression for the kernels' names; empty: all
    std::vector<std::string> arguments;  // further arguments of the program
    std::string out;                     // file
};

struct BaselineArguments {
    std::vector<std::string> scenarios;  // paths or names, of scenarios or of folders with scenarios
    std::string kernels;                 // as above
    std::string out;                     // folder
    int threads = 0;                     // 0: all processors
};

// Runs every kernel under callgrind and writes its number of instructions, in the form of Google Benchmark's JSON.
// Returns whether all kernels computed right results.
bool instructions_command(const InstructionArguments& arguments, std::ostream& out);

// Writes the results of scenarios and kernels that are the same on every machine: DIR/<scenario>.json,
// DIR/kernels.json. Returns whether every technique and kernel kept its promises; the files are written in any case.
bool baseline_command(const BaselineArguments& arguments, std::ostream& out);

// The path of the kernel program: `given`, or, where that is empty, "kernels" beside this program. Throws base::Error
// where it does not exist.
std::string kernel_program(const std::string& given);

}  // namespace shadowbench::service
