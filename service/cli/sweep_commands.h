// The commands that measure a sweep in parts and make one result of them. Each throws base::Error.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "service/cli/commands.h"

namespace shadowbench::service {

struct MergeArguments {
    std::vector<std::string> folders;  // that run --shard has filled
    std::string out;                   // folder; empty: results/runs/<scenario name>
    LibraryArguments libraries;        // with which the cells were measured
    OutputArguments output;
};

struct SweepArguments : RunArguments {
    std::string engine = "slurm";  // or "parallel"
    std::size_t nodes = 0;         // 0: as many as the partition has, or as --ssh names
    std::string partition;         // empty: the default one
    std::vector<std::string> ssh;  // machines; empty: this one
    bool print = false, wait = false;
};

// Returns the exit code: that of the merge where it made the result, else of the first part that failed.
int sweep_command(const SweepArguments& arguments, std::ostream& out, std::ostream& err);

// run --shard. Returns whether every technique kept its promises in every cell of the shard.
bool shard_command(const RunArguments& arguments, std::ostream& out, std::ostream& err);

// Returns whether no cell is missing and every technique kept its promises.
bool merge_command(const MergeArguments& arguments, std::ostream& out, std::ostream& err);

}  // namespace shadowbench::service
