// The commands around the kernels and the committed baseline, once their arguments are read. Each throws base::Error.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace shadowbench::service {

constexpr int wrong_answer = 2;  // exit code of the kernels

struct InstructionArguments {
    std::string kernels;                 // the program; empty: "kernels" beside this one
    std::string filter;                  // regular expression over the kernels' names; empty: all
    std::vector<std::string> arguments;  // further ones of the program
    std::string out;                     // file
};

struct BaselineArguments {
    std::vector<std::string> scenarios;  // each a path or a name, of a scenario or of a folder of them
    std::string kernels;                 // as above
    std::string out;                     // folder
    int threads = 0;                     // 0: all processors
};

// Runs every kernel under callgrind and writes how many instructions it took, in the shape of Google Benchmark's JSON.
// Whether all kernels answered rightly.
bool instructions_command(const InstructionArguments& arguments, std::ostream& out);

// Writes what holds on any machine of scenarios and kernels: DIR/<scenario>.json, DIR/kernels.json. Whether every
// technique and kernel kept its promises; the files are written all the same.
bool baseline_command(const BaselineArguments& arguments, std::ostream& out);

// The program of the kernels: as told, or the one beside this program. Throws base::Error when it is not there.
std::string kernel_program(const std::string& told);

}  // namespace shadowbench::service
