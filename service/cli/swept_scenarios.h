// The scenarios that the arguments of a sweep name: of run --shard and sweep.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "service/cli/commands.h"
#include "service/cli/job.h"
#include "service/cli/sweep_folder.h"

namespace shadowbench::service {

// A scenario of the sweep.
struct Swept {
    std::filesystem::path file;
    Job job;
};

// All scenarios that the arguments name, each with its document checked. Throws Error, place: the file.
std::vector<Swept> read_swept(const RunArguments& arguments);

// What a command needs to measure the same again, but for --shard and --out; of a job, without its scenarios.
std::vector<std::string> arguments_again(const RunArguments& arguments);
std::vector<std::string> arguments_again(const JobArguments& arguments);

Sweep sweep_of(const std::vector<Swept>& swept, const RunArguments& arguments);

}  // namespace shadowbench::service
