// The commands of the regression gate, once their arguments are read. Each throws base::Error.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace shadowbench::service {

struct VerdictArguments {
    double effect = 5.0;                 // percent
    std::vector<std::string> tolerance;  // measure=relative
    bool allow_missing = false;
    bool all = false;                   // every line on the terminal
    bool confirm = false;               // run again what looks slower
    int pairs = 20;                     // interleaved; of --confirm twice as many
    std::string markdown, junit, json;  // files; "-": standard output; empty: none
    std::vector<std::string> data;      // folders, for what is run
};

struct CompareArguments : VerdictArguments {
    std::string baseline, current;   // files or folders
    std::string binary_a, binary_b;  // builds of both sides for --confirm; empty: only the present program
};

struct AbArguments : VerdictArguments {
    std::string binary_a, binary_b;
    std::string scenario;    // empty: kernels
    std::string kernels;     // a regular expression; empty: a scenario
    double min_time = 0.05;  // seconds of one kernel in one process
    std::vector<std::string> set, only;
    std::string out;  // folder that keeps the results; empty: none is kept
};

struct HistoryArguments {
    std::string folder;
    std::string out;  // folder; empty: results/history
    int last = 10;
    double effect = 5.0;  // percent
};

// The exit codes: 0, 1 (slower) or 2 (larger, less accurate, missing).
int compare_command(const CompareArguments& arguments, std::ostream& out, std::ostream& err);
int ab_command(const AbArguments& arguments, std::ostream& out, std::ostream& err);
void history_command(const HistoryArguments& arguments, std::ostream& out);

}  // namespace shadowbench::service
