#include <memory>
#include <ostream>

#include <CLI/CLI.hpp>

#include "service/cli/kernel_commands.h"
#include "service/cli/options.h"

namespace shadowbench::service {
namespace {

void add_kernels_option(CLI::App& command, std::string& program) {
    command.add_option("--kernels", program, "The kernel program [kernels, beside this program]");
}

void add_instructions(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<InstructionArguments>();
    CLI::App* instructions =
        app.add_subcommand("instructions", "Count the instructions of every kernel, for machines too noisy to time");
    set_help(*instructions, command_groups::compare, {"instructions --filter ^compress/ --out counts.json"},
             "Runs the kernels under valgrind's callgrind. The counts can be compared like results.");
    add_kernels_option(*instructions, arguments->kernels);
    instructions->add_option("--filter", arguments->filter,
                             "Run only kernels whose names match this regular expression");
    instructions
        ->add_option("--argument", arguments->arguments,
                     "Pass a further argument to the kernel program, as in --argument=--inject=...")
        ->allow_extra_args(false);
    instructions->add_option("--out", arguments->out, "JSON file of the counts, for compare")->required();
    commands.push_back({instructions, [arguments](std::ostream& out, std::ostream&) {
                            return instructions_command(*arguments, out) ? 0 : promise_broken;
                        }});
}

void add_baseline(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<BaselineArguments>();
    CLI::App* baseline = app.add_subcommand("baseline", "Write the results that are the same on every machine");
    set_help(*baseline, command_groups::compare, {"baseline quickstart scenarios/hard --out results/baseline"},
             "Writes bytes, nodes, errors and promises of scenarios and kernels, without times, for compare.");
    baseline->add_option("SCENARIO", arguments->scenarios, "Scenario files, their names, or folders of them");
    add_kernels_option(*baseline, arguments->kernels);
    baseline->add_option("--out", arguments->out, "Folder of the files. Files of other scenarios in it stay")
        ->required();
    baseline
        ->add_option("--threads", arguments->threads,
                     "Threads; 0: one for each processor. The numbers do not depend on it")
        ->check(CLI::Range(0, 4096));
    commands.push_back({baseline, [arguments](std::ostream& out, std::ostream&) {
                            return baseline_command(*arguments, out) ? 0 : promise_broken;
                        }});
}

}  // namespace

void add_kernel_commands(CLI::App& app, Commands& commands) {
    add_instructions(app, commands);
    add_baseline(app, commands);
}

}  // namespace shadowbench::service
