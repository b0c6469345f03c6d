#include <memory>
#include <ostream>
#include <string>

#include <CLI/CLI.hpp>

#include "service/cli/gate_commands.h"
#include "service/cli/options.h"

namespace shadowbench::service {
namespace {

constexpr const char* verdicts =
    R"(Exact measures (bytes, nodes, errors, promises) hold on any machine and have no noise: more than the tolerance is
larger or less accurate. Times are judged by process, not by repetition, and fewer than 4 processes a side decide
nothing. Exit codes: 0; 1 slower; 2 larger, less accurate, missing, or of another scenario, seed or version.)";

void add_verdict_options(CLI::App& command, VerdictArguments& arguments) {
    command.add_option("--effect", arguments.effect, "Percent: smaller changes of a time are none")
        ->check(CLI::Range(0.0, 1000.0))
        ->capture_default_str();
    repeatable(command.add_option("--tolerance", arguments.tolerance,
                                  "measure=relative tolerance, as in lookup_error.rms=0.01 [none for bytes and nodes, "
                                  "1e-6 for errors, 1e-3 for instructions]"));
    command.add_flag("--allow-missing", arguments.allow_missing,
                     "What is missing, or of another scenario, seed or version, is told, but is no failure");
    command.add_flag("--all", arguments.all, "List also what is the same, and every inconclusive time");
    command.add_option("--markdown", arguments.markdown, "Write it for a pull request (-: to standard output)");
    command.add_option("--junit", arguments.junit, "Write JUnit XML (-: to standard output)");
    command.add_option("--json", arguments.json, "Write JSON (-: to standard output)");
    repeatable(command.add_option("--data", arguments.data, "A folder to look for data in, for what is run"));
}

void add_pairs(CLI::App& command, VerdictArguments& arguments, const char* text) {
    command.add_option("--pairs", arguments.pairs, text)->check(CLI::Range(1, 1000))->capture_default_str();
}

void add_compare(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<CompareArguments>();
    CLI::App* compare = app.add_subcommand("compare", "Judge every cell of a result against a baseline");
    compare
        ->add_option(
            "BASELINE", arguments->baseline,
            "A result.json, JSON of a kernel program, or a folder: all of them below it. Several results of one "
            "scenario are processes of it")
        ->required();
    compare->add_option("CURRENT", arguments->current, "The same")->required();
    add_verdict_options(*compare, *arguments);
    compare->add_flag("--confirm", arguments->confirm,
                      "Run cells that look slower again, builds A and B in turns; slower is only what is so in these "
                      "fresh pairs by themselves. Needs --binary-a");
    compare->add_option("--binary-a", arguments->binary_a, "The build of BASELINE");
    compare->add_option("--binary-b", arguments->binary_b, "The build of CURRENT [this program]");
    add_pairs(*compare, *arguments, "Pairs of --confirm");
    compare->footer(verdicts);
    commands.push_back(
        {compare, [arguments](std::ostream& out, std::ostream& err) { return compare_command(*arguments, out, err); }});
}

void add_ab(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<AbArguments>();
    CLI::App* ab = app.add_subcommand("ab", "Run two builds in turns, A B, B A, ..., and judge B against A");
    ab->add_option("BINARY_A", arguments->binary_a, "The build to judge against")->required();
    ab->add_option("BINARY_B", arguments->binary_b,
                   "The build to judge; the same as A states the smallest difference that can be seen")
        ->required();
    ab->add_option("SCENARIO", arguments->scenario,
                   "A scenario, as for run. Short processes in many pairs see more than long ones: --set "
                   "timing.repetitions=3");
    CLI::Option* kernels = ab->add_option("--kernels", arguments->kernels,
                                          "Instead of a scenario: the programs are kernels (Google Benchmark); those "
                                          "that match this filter");
    ab->add_option("--min-time", arguments->min_time,
                   "Seconds of one kernel in one process; more pairs see more than longer ones")
        ->check(CLI::Range(0.001, 1000.0))
        ->capture_default_str()
        ->needs(kernels);
    CLI::Option* set = ab->add_option("--set", arguments->set, "path=value, as for run");
    CLI::Option* only = ab->add_option("--only", arguments->only, "Only techniques of this type");
    for (CLI::Option* of_scenario : {set, only}) {
        repeatable(of_scenario);
        of_scenario->excludes(kernels);
    }
    add_pairs(*ab, *arguments, "Pairs of processes; on a busy machine 20 tell some 1 to 5 percent from none");
    ab->add_option("--out", arguments->out,
                   "Keep the results in this folder, in a/ and b/, for compare [none is kept]");
    add_verdict_options(*ab, *arguments);
    ab->add_flag("--confirm", arguments->confirm,
                 "Run cells that look slower again, in twice as many pairs; slower is only what is so in these fresh "
                 "pairs by themselves");
    ab->footer(verdicts);
    commands.push_back(
        {ab, [arguments](std::ostream& out, std::ostream& err) { return ab_command(*arguments, out, err); }});
}

void add_history(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<HistoryArguments>();
    CLI::App* history = app.add_subcommand("history", "Every measure of every cell over many results, and what drifts");
    history->add_option("DIR", arguments->folder, "A folder: every result and kernel file below it")->required();
    history->add_option("--out", arguments->out, "Folder of history.json and the page history.html [results/history]");
    history->add_option("--last", arguments->last, "A drift is looked for in so many of the latest results")
        ->check(CLI::Range(6, 1000))
        ->capture_default_str();
    history->add_option("--effect", arguments->effect, "Percent: smaller drifts of a time are none")
        ->check(CLI::Range(0.0, 1000.0))
        ->capture_default_str();
    commands.push_back({history, [arguments](std::ostream& out, std::ostream&) {
                            history_command(*arguments, out);
                            return 0;
                        }});
}

}  // namespace

void add_gate_commands(CLI::App& app, Commands& commands) {
    for (const auto add : {add_compare, add_ab, add_history}) add(app, commands);
}

}  // namespace shadowbench::service
