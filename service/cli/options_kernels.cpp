#include <memory>
#include <ostream>

#include <CLI/CLI.hpp>

#include "service/cli/kernel_commands.h"
#include "service/cli/options.h"

namespace shadowbench::service {
namespace {

void add_kernels_option(CLI::App& command, std::string& program) {
    command.add_option("--kernels", program, "The program of the kernels [the one beside this program]");
}

void add_instructions(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<InstructionArguments>();
    CLI::App* instructions = app.add_subcommand(
        "instructions", "Count the instructions of every kernel under callgrind: for machines too noisy for times");
    add_kernels_option(*instructions, arguments->kernels);
    instructions->add_option("--filter", arguments->filter, "Only kernels in whose names this expression is found");
    instructions
        ->add_option("--argument", arguments->arguments,
                     "A further argument of that program, as in --argument=--inject=...")
        ->allow_extra_args(false);
    instructions->add_option("--out", arguments->out, "File of the counts, for compare")->required();
    commands.push_back({instructions, [arguments](std::ostream& out, std::ostream&) {
                            return instructions_command(*arguments, out) ? 0 : promise_broken;
                        }});
}

void add_baseline(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<BaselineArguments>();
    CLI::App* baseline = app.add_subcommand(
        "baseline", "Write what scenarios and kernels count, without times: it holds on any machine, and is compared");
    baseline->add_option("SCENARIO", arguments->scenarios, "Scenario files, their names, or folders of them");
    add_kernels_option(*baseline, arguments->kernels);
    baseline->add_option("--out", arguments->out, "Folder; files of other scenarios in it stay")->required();
    baseline->add_option("--threads", arguments->threads, "Threads; 0: all (the numbers are the same)")
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
