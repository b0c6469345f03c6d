// The machine that a result records, and its state when the run starts.
#pragma once

#include <filesystem>

#include "results/result.h"

namespace shadowbench::results {

// The machine that runs this program. `root`: the folder that holds proc/ and sys/.
Machine this_machine(const std::filesystem::path& root = "/");

// Sets the load, and the job and node of Slurm, from the environment.
void add_state(RunTimes& times, const std::filesystem::path& root = "/");

// With the time and the state of now.
RunTimes times_at_start();

}  // namespace shadowbench::results
