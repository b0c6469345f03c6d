#include "service/cli/slurm_queue.h"

#include <set>
#include <sstream>

#include <fmt/format.h>

#include "base/error.h"
#include "service/cli/child.h"
#include "service/jobs/child.h"

namespace shadowbench::service {

using base::Error;
using base::ErrorCode;

namespace {

constexpr double longest_answer = 60.0;  // seconds

std::string joined_lines(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    for (std::size_t at; (at = text.find('\n')) != std::string::npos;) text.replace(at, 1, "; ");
    return text;
}

std::string list_of(const std::set<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return list.empty() ? "none" : list;
}

}  // namespace

std::vector<std::string> ask_slurm(const std::string& command, const std::vector<std::string>& words) {
    const std::string program =
        find_program(command,
                     "run this where Slurm's commands are (package slurm-client), use --engine parallel, or --print "
                     "the commands and run them there");
    ChildLimits limits;
    limits.seconds = longest_answer;
    std::vector<std::string> lines;
    const ChildReport report = run_child(
        program, words, limits, [&](std::string_view line) { lines.emplace_back(line); }, [] { return false; });
    if (report.end == ChildEnd::exited && report.code == 0) return lines;
    const std::string says = joined_lines(report.errors);
    const bool late = report.end == ChildEnd::out_of_time;
    const std::string why = late           ? fmt::format("does not answer within {:g} s", longest_answer)
                            : says.empty() ? fmt::format("failed with exit code {}", report.code)
                                           : says;
    throw Error(ErrorCode::io, command, why + "; sinfo and scontrol ping show the state of Slurm");
}

std::size_t nodes_of(const std::string& partition) {
    std::set<std::string> nodes, partitions;
    for (const std::string& line : ask_slurm("sinfo", {"--noheader", "--Node", "--format=%P %N"})) {
        std::istringstream words(line);
        std::string name, node;
        words >> name >> node;
        const bool is_default = !name.empty() && name.back() == '*';
        if (is_default) name.pop_back();
        partitions.insert(name);
        if (partition.empty() ? is_default : name == partition) nodes.insert(node);
    }
    if (!nodes.empty()) return nodes.size();
    const std::string there = "name one with --partition; there are: " + list_of(partitions);
    throw Error(
        ErrorCode::usage, partition.empty() ? "--partition" : "--partition " + partition,
        (partition.empty() ? "Slurm has no default partition; " : "Slurm has no such partition with nodes; ") + there);
}

std::string submit_job(const std::vector<std::string>& words) {
    const std::vector<std::string> lines = ask_slurm("sbatch", words);
    // "12", or "12;cluster".
    const std::string id = lines.empty() ? "" : lines.back().substr(0, lines.back().find(';'));
    if (id.empty() || id.find_first_not_of("0123456789") != std::string::npos)
        throw Error(ErrorCode::io, "sbatch", "printed no number of a job");
    return id;
}

void cancel_job(const std::string& id) {
    try {
        ask_slurm("scancel", {id});
    } catch (const Error&) {
        // The error that made this necessary is reported.
    }
}

std::vector<QueuedJob> queued_jobs(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ",") + name;
    std::vector<QueuedJob> jobs;
    for (const std::string& line :
         ask_slurm("squeue", {"--noheader", "--me", "--array", "--name=" + list, "--format=%j %T %r"})) {
        std::istringstream words(line);
        QueuedJob job;
        words >> job.name >> job.state;
        std::getline(words >> std::ws, job.reason);
        jobs.push_back(std::move(job));
    }
    return jobs;
}

}  // namespace shadowbench::service
