#include <memory>
#include <ostream>
#include <string>

#include <CLI/CLI.hpp>

#include "service/cli/gate_commands.h"
#include "service/cli/options.h"

namespace shadowbench::service {
namespace {

constexpr const char* verdicts =
    R"(Bytes, nodes, errors and promises are the same on every machine: a change beyond the tolerance is a verdict.
Times have noise: each process counts as one observation, and fewer than 4 processes per side decide nothing.
Exit codes: 0; 1 slower; 2 larger, less accurate, missing, or of another scenario, seed or version.)";

void add_verdict_options(CLI::App& command, VerdictArguments& arguments) {
    command.add_option("--effect", arguments.effect, "Percent: a smaller change of a time does not count")
        ->check(CLI::Range(0.0, 1000.0))
        ->capture_default_str();
    repeatable(
        command.add_option("--tolerance", arguments.tolerance,
                           "measure=relative tolerance, as in lookup_error.rms=0.01 [0 for bytes and nodes, 1e-6 "
                           "for errors, 1e-3 for instructions]"));
    command.add_flag("--allow-missing", arguments.allow_missing,
                     "Report cells that are missing, or of another scenario, seed or version, but do not fail");
    command.add_flag("--all", arguments.all, "List unchanged measures and inconclusive times too");
    command.add_option("--markdown", arguments.markdown,
                       "Write the verdicts as Markdown to this file (-: standard output)");
    command.add_option("--junit", arguments.junit, "Write the verdicts as JUnit XML to this file (-: standard output)");
    command.add_option("--json", arguments.json, "Write the verdicts as JSON to this file (-: standard output)");
    repeatable(
        command.add_option("--data", arguments.data, "Scenarios that are run look for data in this folder first"));
}

void add_pairs(CLI::App& command, VerdictArguments& arguments, const char* text) {
    command.add_option("--pairs", arguments.pairs, text)->check(CLI::Range(1, 1000))->capture_default_str();
}

void add_compare(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<CompareArguments>();
    CLI::App* compare = app.add_subcommand("compare", "Judge every cell of a result against a baseline");
    set_help(*compare, command_groups::compare,
             {"compare nightly/monday nightly/tuesday --markdown verdict.md",
              "compare before after --confirm --binary-a old/shadowbench --binary-b build/release/shadowbench"},
             verdicts);
    compare
        ->add_option(
            "BASELINE", arguments->baseline,
            "A result.json, the JSON of a kernel program, or a folder with any number of them. Several results of "
            "one scenario count as several processes")
        ->required();
    compare->add_option("CURRENT", arguments->current, "The result to judge; given like BASELINE")->required();
    add_verdict_options(*compare, *arguments);
    compare->add_flag("--confirm", arguments->confirm,
                      "Run cells that look slower again, builds A and B in turns. Only a cell that is slower in these "
                      "new pairs too is called slower. Needs --binary-a");
    compare->add_option("--binary-a", arguments->binary_a, "The build of BASELINE");
    compare->add_option("--binary-b", arguments->binary_b, "The build of CURRENT [this program]");
    add_pairs(*compare, *arguments, "Pairs of processes that --confirm runs");
    commands.push_back(
        {compare, [arguments](std::ostream& out, std::ostream& err) { return compare_command(*arguments, out, err); }});
}

void add_ab(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<AbArguments>();
    CLI::App* ab = app.add_subcommand("ab", "Run two builds in turns and judge the second against the first");
    set_help(*ab, command_groups::compare,
             {"ab old/shadowbench build/release/shadowbench hairball --only deep",
              "ab old/kernels build/release/kernels --kernels ^compress/",
              "ab build/release/shadowbench build/release/shadowbench quickstart --pairs 40"},
             verdicts);
    ab->add_option("BINARY_A", arguments->binary_a, "The build to judge against")->required();
    ab->add_option("BINARY_B", arguments->binary_b,
                   "The build to judge. If it is BINARY_A again, the verdict states the smallest difference that the "
                   "test can see")
        ->required();
    ab->add_option("SCENARIO", arguments->scenario,
                   "A scenario, as for run. Many pairs of short processes (--set timing.repetitions=3) see smaller "
                   "differences than few pairs of long ones");
    CLI::Option* kernels =
        ab->add_option("--kernels", arguments->kernels,
                       "The programs are kernels (Google Benchmark): run those whose names match this "
                       "expression, instead of a scenario");
    ab->add_option("--min-time", arguments->min_time,
                   "Seconds that one kernel runs in one process. More pairs see smaller differences than longer runs")
        ->check(CLI::Range(0.001, 1000.0))
        ->capture_default_str()
        ->needs(kernels);
    CLI::Option* set =
        ab->add_option("--set", arguments->set, "path=value: change one value of the scenario, as for run");
    CLI::Option* only = ab->add_option("--only", arguments->only, "Measure only techniques of this type");
    for (CLI::Option* scenario_option : {set, only}) {
        repeatable(scenario_option);
        scenario_option->excludes(kernels);
    }
    add_pairs(*ab, *arguments, "Pairs of processes. On a busy machine 20 pairs can see a difference of 1 to 5 percent");
    ab->add_option("--out", arguments->out,
                   "Keep the results in this folder, in a/ and b/, for compare [deleted at the end]");
    add_verdict_options(*ab, *arguments);
    ab->add_flag("--confirm", arguments->confirm,
                 "Run cells that look slower again, in twice as many pairs. Only a cell that is slower in these new "
                 "pairs too is called slower");
    commands.push_back(
        {ab, [arguments](std::ostream& out, std::ostream& err) { return ab_command(*arguments, out, err); }});
}

void add_history(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<HistoryArguments>();
    CLI::App* history = app.add_subcommand("history", "Follow every measure over many results and find drifts");
    set_help(*history, command_groups::compare, {"history results/nightly", "history results/nightly --last 20"});
    history->add_option("DIR", arguments->folder, "Folder of the results and kernel files, at any depth")->required();
    history->add_option("--out", arguments->out, "Folder of history.json and the page history.html [results/history]");
    history->add_option("--last", arguments->last, "Look for a drift in this many of the latest results")
        ->check(CLI::Range(6, 1000))
        ->capture_default_str();
    history->add_option("--effect", arguments->effect, "Percent: a smaller drift of a time does not count")
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
