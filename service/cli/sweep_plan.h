// The commands of sweep: what it prints, and what it starts.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "service/cli/commands.h"

namespace shadowbench::service {

// Beside the cells, DIR has for each part
//   batch/part-<i>.log    what it printed, in all its runs
//   batch/exit-<i>        its exit code; not there while it runs, or if it was ended with its shell
// and batch/merge.log, batch/exit-merge, and the result/.
struct SweepPlan {
    std::string program;                 // a file that all machines see
    std::vector<std::string> arguments;  // of run: scenarios and options
    LibraryArguments libraries;          // of merge; the arguments of run have them too
    std::filesystem::path folder;        // DIR, absolute
    std::size_t parts = 1;
    std::string partition;         // of Slurm; empty: the default one
    std::vector<std::string> ssh;  // machines of GNU parallel; empty: this one
};

// Names the sweep's folder in Slurm's queue: jobs of one folder are found by it.
std::string parts_job(const SweepPlan& plan);
std::string merge_job(const SweepPlan& plan);

std::filesystem::path batch_folder(const SweepPlan& plan);
std::filesystem::path part_log(const SweepPlan& plan, std::size_t part);
std::filesystem::path exit_file(const SweepPlan& plan, const std::string& of);  // a part's number, or "merge"
std::filesystem::path result_folder(const SweepPlan& plan);

// The arguments of sbatch. `after`: the id of the array job, or for a shell a variable with it.
std::vector<std::string> parts_words(const SweepPlan& plan);
std::vector<std::string> merge_words(const SweepPlan& plan, const std::string& after);

// The arguments of GNU parallel, which reads the commands of all parts, a zero byte after each. `joblog`: what earlier
// runs of these commands by this program, with these libraries, finished; such parts are not run again.
std::vector<std::string> parallel_words(const SweepPlan& plan);
std::filesystem::path joblog(const SweepPlan& plan);
std::string parallel_input(const SweepPlan& plan);

// All of it as a script for a shell.
std::string slurm_script(const SweepPlan& plan);
std::string parallel_script(const SweepPlan& plan);

}  // namespace shadowbench::service
