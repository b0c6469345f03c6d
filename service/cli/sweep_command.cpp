#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/read_text.h"
#include "base/shell_word.h"
#include "service/cli/child.h"
#include "service/cli/options.h"
#include "service/cli/progress_bar.h"
#include "service/cli/slurm_queue.h"
#include "service/cli/sweep_commands.h"
#include "service/cli/sweep_folder.h"
#include "service/cli/sweep_plan.h"
#include "service/cli/swept_scenarios.h"
#include "service/cli/this_program.h"
#include "service/jobs/child.h"

namespace shadowbench::service {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds first_pause{250}, longest_pause{5000};  // between two looks at the queue
constexpr std::chrono::minutes longest_silence{10};                         // of the scheduler
// Seconds. Its jobs are in groups of their own: only GNU parallel itself, asked by SIGTERM, ends them, in less.
constexpr double parallel_farewell = 1.0;
constexpr std::chrono::seconds late_file{1};  // that a common disk may take to show a file of another machine

void refuse_mixed(const SweepArguments& arguments) {
    const bool slurm = arguments.engine == "slurm";
    if (slurm && !arguments.ssh.empty())
        throw Error(ErrorCode::usage, "--ssh", "is for --engine parallel; Slurm chooses its nodes: see --partition");
    if (!slurm && !arguments.partition.empty())
        throw Error(ErrorCode::usage, "--partition", "is Slurm's; name machines with --ssh for --engine parallel");
}

SweepPlan plan_of(const SweepArguments& arguments, std::size_t cells) {
    SweepPlan plan;
    plan.program = this_program();
    plan.arguments = arguments_again(arguments);
    plan.libraries = arguments.libraries;
    // As one name for the same folder.
    plan.folder = fs::weakly_canonical(fs::absolute(arguments.out));
    plan.partition = arguments.partition;
    plan.ssh = arguments.ssh;
    plan.parts = arguments.nodes;
    if (plan.parts == 0)
        plan.parts = arguments.engine == "slurm" ? nodes_of(arguments.partition)
                                                 : std::max<std::size_t>(1, arguments.ssh.size());
    plan.parts = std::min(plan.parts, cells);
    return plan;
}

// The exit code that a part, or the merge, has left.
std::optional<int> exit_code(const SweepPlan& plan, const std::string& of) {
    std::ifstream file(exit_file(plan, of));
    int code = 0;
    return file >> code ? std::optional(code) : std::nullopt;
}

std::string end_of_log(const fs::path& log) {
    std::ifstream file(log);
    std::string last;
    for (std::string line; std::getline(file, line);)
        if (!line.empty()) last = line;
    return last;
}

// Names the parts that failed. Returns the exit code of the first; 0: none did.
int report_parts(const SweepPlan& plan, std::ostream& out) {
    int first = 0;
    for (std::size_t part = 0; part < plan.parts; ++part) {
        const int code = exit_code(plan, std::to_string(part)).value_or(0);
        if (code < static_cast<int>(ErrorCode::usage)) continue;  // of broken promises, the merge knows
        const fs::path log = part_log(plan, part);
        out << fmt::format("part {} ended with exit code {}; {} ends: {}\n", part, code, log.string(), end_of_log(log));
        if (first == 0) first = code;
    }
    return first;
}

// A merge that has all cells is a success, whatever happened to parts before.
int whole_code(int merge, int parts) {
    return merge == promise_broken && parts != 0 ? parts : merge;
}

int merge_here(const SweepPlan& plan, std::ostream& out, std::ostream& err) {
    MergeArguments merge;
    merge.folders = {plan.folder.string()};
    merge.out = result_folder(plan).string();
    merge.libraries = plan.libraries;
    return merge_command(merge, out, err) ? 0 : promise_broken;
}

std::size_t cells_there(const SweepPlan& plan, const std::vector<PlannedCell>& cells) {
    std::error_code failed;
    return static_cast<std::size_t>(std::count_if(cells.begin(), cells.end(), [&](const PlannedCell& cell) {
        return fs::exists(cell_file(plan.folder, cell), failed);
    }));
}

// "3 running, 1 waiting (Resources)".
std::string text_of(const std::vector<QueuedJob>& jobs, const SweepPlan& plan) {
    std::map<std::string, std::size_t> counts;
    for (const QueuedJob& job : jobs) {
        if (job.name == merge_job(plan)) continue;
        const bool runs = job.state == "RUNNING" || job.state == "COMPLETING";
        ++counts[runs ? "running" : "waiting (" + job.reason + ")"];
    }
    std::string text;
    for (const auto& [what, count] : counts) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
    return text.empty() ? "merging" : text;
}

std::vector<QueuedJob> jobs_of(const SweepPlan& plan) {
    return queued_jobs({parts_job(plan), merge_job(plan)});
}

void pause(const EndingSignals& signals, std::chrono::milliseconds time) {
    for (const auto end = Clock::now() + time; Clock::now() < end;)
        if (const int signal = signals.wait()) throw Interrupted{signal};
}

// Waits until Slurm has no job of the sweep left.
void follow(const SweepPlan& plan, const std::vector<PlannedCell>& cells, std::ostream& err) {
    const EndingSignals signals;
    ProgressBar bar(err);
    auto answered = Clock::now();
    for (auto between = first_pause;; between = std::min(2 * between, longest_pause)) {
        std::string text = "no answer from squeue";
        try {
            const std::vector<QueuedJob> jobs = jobs_of(plan);
            if (jobs.empty()) return;
            answered = Clock::now();
            text = text_of(jobs, plan);
        } catch (const Error& error) {
            if (error.code() != ErrorCode::io) throw;
            if (Clock::now() - answered > longest_silence)
                throw Error(error.code(), error.where(),
                            error.message() + "; the jobs may go on: the same command again follows them");
        }
        bar.show({text + ",", "cells", cells_there(plan, cells), cells.size()});
        pause(signals, between);
    }
}

// Once all jobs have ended: prints what the merge printed, and what failed. Merges here if Slurm did not: its
// controller forgets jobs of the last seconds if it is killed, and a merge can be cancelled.
int report_slurm(const SweepPlan& plan, std::ostream& out, std::ostream& err) {
    std::optional<int> merge;
    for (const auto end = Clock::now() + late_file; !(merge = exit_code(plan, "merge")) && Clock::now() < end;)
        std::this_thread::sleep_for(first_pause);
    if (merge) {
        out << base::read_text(batch_folder(plan) / "merge.log");
    } else {
        out << "Slurm did not merge the parts; merged here.\n" << std::flush;
        merge = merge_here(plan, out, err);
    }
    return whole_code(*merge, report_parts(plan, out));
}

void submit(const SweepPlan& plan, std::size_t cells, std::ostream& out) {
    const EndingSignals both;  // a signal does not come between the two jobs
    const std::string parts = submit_job(parts_words(plan));
    std::string merge;
    try {
        merge = submit_job(merge_words(plan, parts));
    } catch (...) {
        cancel_job(parts);
        throw;
    }
    out << fmt::format("submitted: job {}, {} part{} of {} cells, and job {}, which merges them into {}\n", parts,
                       plan.parts, plan.parts == 1 ? "" : "s", cells, merge, result_folder(plan).string())
        << fmt::format("logs: {}\n", batch_folder(plan).string()) << std::flush;
}

// Exit codes of an earlier run of the sweep.
void forget_codes(const SweepPlan& plan) {
    std::error_code ignored;
    std::vector<fs::path> old;
    for (const auto& entry : fs::directory_iterator(batch_folder(plan), ignored))
        if (entry.path().filename().string().starts_with("exit-")) old.push_back(entry.path());
    for (const fs::path& file : old) fs::remove(file, ignored);
}

int with_slurm(const SweepPlan& plan, const std::vector<PlannedCell>& cells, bool wait, std::ostream& out,
               std::ostream& err) {
    const std::vector<QueuedJob> before = jobs_of(plan);
    if (before.empty()) {
        forget_codes(plan);
        submit(plan, cells.size(), out);
    } else {
        out << fmt::format("in the queue since an earlier call: {}; {} of {} cells are there\n", text_of(before, plan),
                           cells_there(plan, cells), cells.size())
            << std::flush;
    }
    if (!wait) {
        out << "The same command with --wait follows them.\n";
        return 0;
    }
    follow(plan, cells, err);
    return report_slurm(plan, out, err);
}

// Runs GNU parallel to its end. Throws Error{io} if it could not run the parts.
void run_parallel(const SweepPlan& plan, const std::vector<PlannedCell>& cells, const std::string& program,
                  std::ostream& err) {
    const fs::path list = batch_folder(plan) / "commands", log = batch_folder(plan) / "parallel.log";
    std::ofstream(list) << parallel_input(plan);
    // The shell opens the list for it.
    std::vector<std::string> words{"-c", "exec \"$0\" \"$@\" <" + base::shell_word(list.string()), program};
    for (const std::string& word : parallel_words(plan)) words.push_back(word);
    const EndingSignals signals;
    ProgressBar bar(err);
    ChildLimits limits;
    limits.seconds = 1e9;
    limits.farewell = parallel_farewell;
    int signal = 0;
    auto next = Clock::now();
    const ChildReport report = run_child(
        "/bin/sh", words, limits, [](std::string_view) {},
        [&] {
            if (Clock::now() > next) {
                bar.show({std::to_string(plan.parts) + " parts,", "cells", cells_there(plan, cells), cells.size()});
                next = Clock::now() + first_pause;
            }
            return (signal = signals.wait()) != 0;
        });
    if (signal != 0) throw Interrupted{signal};
    // Up to 101 is the number of parts that failed.
    if (report.end != ChildEnd::exited || report.code > 101)
        throw Error(ErrorCode::io, program,
                    fmt::format("GNU parallel failed: {}", report.errors.empty() ? "it was ended" : report.errors));
}

int with_parallel(const SweepPlan& plan, const std::vector<PlannedCell>& cells, std::ostream& out, std::ostream& err) {
    const std::string program = find_program("parallel", "install GNU parallel (package parallel)");
    find_program("setpriv", "install util-linux; it lets parts end with the sweep");
    const auto failed = [&] {
        for (std::size_t part = 0; part < plan.parts; ++part)
            if (exit_code(plan, std::to_string(part)).value_or(1) != 0) return true;
        return false;
    };
    run_parallel(plan, cells, program, err);
    // The log of an earlier run knows parts as finished whose cells were removed since.
    if (cells_there(plan, cells) < cells.size() && !failed()) {
        fs::remove(joblog(plan));
        run_parallel(plan, cells, program, err);
    }
    const int merge = merge_here(plan, out, err);
    return whole_code(merge, report_parts(plan, out));
}

}  // namespace

int sweep_command(const SweepArguments& arguments, std::ostream& out, std::ostream& err) {
    refuse_mixed(arguments);
    const std::vector<Swept> swept = read_swept(arguments);
    const Sweep sweep = sweep_of(swept, arguments);
    const std::vector<PlannedCell> cells = planned_cells(sweep);
    const SweepPlan plan = plan_of(arguments, cells.size());
    const bool slurm = arguments.engine == "slurm";
    if (arguments.print) {
        out << (slurm ? slurm_script(plan) : parallel_script(plan));
        return 0;
    }
    begin_sweep(plan.folder, sweep);
    fs::create_directories(batch_folder(plan));
    return slurm ? with_slurm(plan, cells, arguments.wait, out, err) : with_parallel(plan, cells, out, err);
}

}  // namespace shadowbench::service
