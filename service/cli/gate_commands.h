// The commands that compare results, with their parsed arguments. Each throws base::Error.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace shadowbench::service {

struct VerdictArguments {
    double effect = 5.0;                 // percent
    std::vector<std::string> tolerance;  // measure=relative
    bool allow_missing = false;
    bool all = false;                   // print every line
    bool confirm = false;               // run cells again that look slower
    int pairs = 20;                     // of processes, in turns; ab --confirm runs twice as many
    std::string markdown, junit, json;  // files; "-": standard output; empty: none
    std::vector<std::string> data;      // folders with the data of scenarios that are run
};

struct CompareArguments : VerdictArguments {
    std::string baseline, current;   // files or folders
    std::string binary_a, binary_b;  // builds for --confirm; binary_b empty: this program
};

struct AbArguments : VerdictArguments {
    std::string binary_a, binary_b;
    std::string scenario;    // empty: kernels
    std::string kernels;     // a regular expression; empty: a scenario
    double min_time = 0.05;  // seconds of one kernel in one process
    std::vector<std::string> set, only;
    std::string out;  // folder of the results; empty: they are deleted
};

struct HistoryArguments {
    std::string folder;
    std::string out;  // folder; empty: results/history
    int last = 10;
    double effect = 5.0;  // percent
};

// Return the exit code: 0, 1 (slower) or 2 (larger, less accurate, missing).
int compare_command(const CompareArguments& arguments, std::ostream& out, std::ostream& err);
int ab_command(const AbArguments& arguments, std::ostream& out, std::ostream& err);
void history_command(const HistoryArguments& arguments, std::ostream& out);

}  // namespace shadowbench::service
