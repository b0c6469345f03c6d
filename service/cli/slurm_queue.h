// Asks Slurm by its commands: no library of it is linked.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace shadowbench::service {

// The number of nodes of a partition; empty: of the default one. Throws Error{usage} if there is no such partition, or
// no default one, with the names of those that there are, and what ask_slurm() throws.
std::size_t nodes_of(const std::string& partition);

// Submits a job and returns its id. Throws what ask_slurm() throws.
std::string submit_job(const std::vector<std::string>& words);

void cancel_job(const std::string& id);  // as far as Slurm answers

struct QueuedJob {
    std::string name, state, reason;  // "RUNNING"; why it waits: "Resources"
};

// The user's jobs of these names, each task of an array by itself; jobs that have ended are not among them. Throws what
// ask_slurm() throws.
std::vector<QueuedJob> queued_jobs(const std::vector<std::string>& names);

// Runs a command of Slurm, and returns the lines that it prints. Throws Error{no_such_file} if it is not there, and
// Error{io} with what it says if it fails or takes more than a minute.
std::vector<std::string> ask_slurm(const std::string& command, const std::vector<std::string>& words);

}  // namespace shadowbench::service
