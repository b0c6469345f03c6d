#include "service/cli/sweep_plan.h"

#include <utility>

#include <fmt/format.h>

#include "base/hash_text.h"
#include "base/shell_word.h"
#include "results/program.h"
#include "service/cli/libraries.h"

namespace shadowbench::service {

namespace fs = std::filesystem;
using base::shell_word;

namespace {

std::string line_of(const std::vector<std::string>& words) {
    std::string line;
    for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_word(word);
    return line;
}

std::string keep_code(const SweepPlan& plan, const std::string& of) {
    return fmt::format("echo $code >{}{}; exit $code", shell_word((batch_folder(plan) / "exit-").string()), of);
}

// Starts a command that the kernel kills when the one who started it ends, even by SIGKILL. GNU parallel puts each part
// into a group of its own, so that nothing else would end the parts of a killed sweep. Slurm ends its own.
const std::vector<std::string> bound{"setpriv", "--pdeathsig", "KILL"};

// Runs a part. A program that a fault or the kernel killed (SIGILL to SIGSEGV, SIGKILL among them) is started again
// twice: it continues with the next cell that is missing. `part`: a number, or what a shell replaces by it. `prefix`:
// words before the program.
std::string part_text(const SweepPlan& plan, const std::string& part, std::vector<std::string> prefix = {}) {
    std::vector<std::string> run = std::move(prefix);
    run.insert(run.end(), {plan.program, "run"});
    run.insert(run.end(), plan.arguments.begin(), plan.arguments.end());
    return fmt::format(
        "for try in 1 2 3; do {} --shard {}/{} --out {}; code=$?; [ $code -ge 132 ] && [ $code -le 139 ] || break; "
        "done; {}",
        line_of(run), part, plan.parts, shell_word(plan.folder.string()), keep_code(plan, part));
}

std::string merge_line(const SweepPlan& plan) {
    std::vector<std::string> words{plan.program, "merge", plan.folder.string(), "--out", result_folder(plan).string()};
    for (const std::string& word : library_arguments(plan.libraries)) words.push_back(word);
    return line_of(words);
}

// sbatch replaces % and a letter in names of logs.
std::string log_pattern(const SweepPlan& plan, const char* name) {
    std::string pattern;
    for (const char c : batch_folder(plan).string()) pattern += c == '%' ? std::string("%%") : std::string(1, c);
    return pattern + "/" + name;
}

std::vector<std::string> job_words(const SweepPlan& plan, const std::string& name, const char* log) {
    std::vector<std::string> words{"--parsable", "--job-name=" + name, "--nodes=1",
                                   "--ntasks=1", "--requeue",          "--output=" + log_pattern(plan, log)};
    if (!plan.partition.empty()) words.push_back("--partition=" + plan.partition);
    return words;
}

std::string folder_hash(const SweepPlan& plan) {
    return base::hash_text(plan.folder.string());
}

std::string shell_command(const std::string& program, const std::vector<std::string>& words) {
    return program + " " + line_of(words);
}

// A line for the shell of GNU parallel.
std::string part_line(const SweepPlan& plan, std::size_t part) {
    const std::string script = fmt::format("exec >>{} 2>&1; {}", shell_word(part_log(plan, part).string()),
                                           part_text(plan, std::to_string(part), bound));
    std::vector<std::string> words = bound;
    words.insert(words.end(), {"sh", "-c", script});
    return "exec " + line_of(words);
}

}  // namespace

std::string parts_job(const SweepPlan& plan) {
    return "sweep-" + folder_hash(plan);
}

std::string merge_job(const SweepPlan& plan) {
    return "merge-" + folder_hash(plan);
}

fs::path batch_folder(const SweepPlan& plan) {
    return plan.folder / "batch";
}

fs::path part_log(const SweepPlan& plan, std::size_t part) {
    return batch_folder(plan) / fmt::format("part-{}.log", part);
}

fs::path exit_file(const SweepPlan& plan, const std::string& of) {
    return batch_folder(plan) / ("exit-" + of);
}

fs::path result_folder(const SweepPlan& plan) {
    return plan.folder / "result";
}

std::vector<std::string> parts_words(const SweepPlan& plan) {
    std::vector<std::string> words = job_words(plan, parts_job(plan), "part-%a.log");
    words.insert(words.end(), {fmt::format("--array=0-{}", plan.parts - 1), "--exclusive", "--open-mode=append",
                               "--wrap=" + part_text(plan, "$SLURM_ARRAY_TASK_ID")});
    return words;
}

// Not afterok: behind a part that failed, such a merge would wait for ever.
std::vector<std::string> merge_words(const SweepPlan& plan, const std::string& after) {
    std::vector<std::string> words = job_words(plan, merge_job(plan), "merge.log");
    words.insert(words.end(), {"--dependency=afterany:" + after, "--open-mode=truncate",
                               fmt::format("--wrap={}; code=$?; {}", merge_line(plan), keep_code(plan, "merge"))});
    return words;
}

std::vector<std::string> parallel_words(const SweepPlan& plan) {
    std::vector<std::string> words{"--null", "--will-cite", "--jobs=1", "--joblog=" + joblog(plan).string(),
                                   "--resume-failed"};
    for (const std::string& machine : plan.ssh) words.push_back("--sshlogin=" + machine);
    if (!plan.ssh.empty()) words.push_back("--workdir=" + fs::current_path().string());
    return words;
}

fs::path joblog(const SweepPlan& plan) {
    const results::Program own = results::this_program();
    return batch_folder(plan) / ("joblog-" + base::hash_text(fmt::format("{} {} {} {}", own.version, own.commit,
                                                                         hash_of_libraries(), part_text(plan, "i"))));
}

std::string parallel_input(const SweepPlan& plan) {
    std::string input;
    for (std::size_t part = 0; part < plan.parts; ++part) input += part_line(plan, part) + '\0';
    return input;
}

std::string slurm_script(const SweepPlan& plan) {
    std::vector<std::string> merge = merge_words(plan, "");
    const std::string batch = shell_word(batch_folder(plan).string());
    // The id is only known to the shell that runs this.
    std::string merging = "sbatch";
    for (const std::string& word : merge)
        merging += " " + (word == "--dependency=afterany:" ? word + "\"${parts%%;*}\"" : shell_word(word));
    return fmt::format("mkdir -p {0} && rm -f {0}/exit-* &&\nparts=$({1}) &&\n{2}\n", batch,
                       shell_command("sbatch", parts_words(plan)), merging);
}

std::string parallel_script(const SweepPlan& plan) {
    std::string commands;
    for (std::size_t part = 0; part < plan.parts; ++part) commands += " " + shell_word(part_line(plan, part));
    return fmt::format("mkdir -p {} &&\nprintf '%s\\0'{} |\n{}\n{}\n", shell_word(batch_folder(plan).string()),
                       commands, shell_command("parallel", parallel_words(plan)), merge_line(plan));
}

}  // namespace shadowbench::service
