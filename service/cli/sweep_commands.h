// The commands that measure a sweep in parts and make one result of them. Each throws base::Error.
#pragma once

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

// run --shard. Returns whether every technique kept its promises in every cell of the shard.
bool shard_command(const RunArguments& arguments, std::ostream& out, std::ostream& err);

// Returns whether no cell is missing and every technique kept its promises.
bool merge_command(const MergeArguments& arguments, std::ostream& out, std::ostream& err);

}  // namespace shadowbench::service
