// The commands with their options, a group a file.
#pragma once

#include <functional>
#include <iosfwd>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace shadowbench::service {

struct Command {
    CLI::App* app;                                                 // the subcommand, with its options
    std::function<int(std::ostream& out, std::ostream& err)> run;  // the exit code; throws base::Error
};
using Commands = std::vector<Command>;

constexpr int promise_broken = 2;  // exit code: less accurate than a technique says

// One value an option, as often as the option is given: a positional argument after it stays one.
void repeatable(CLI::Option* option);

// Each adds its subcommands to the application, and what each runs once the arguments are parsed.
void add_measuring_commands(CLI::App& app, Commands& commands);
void add_job_commands(CLI::App& app, Commands& commands);
void add_server_commands(CLI::App& app, Commands& commands);
void add_gate_commands(CLI::App& app, Commands& commands);  // compare, ab, history
void add_kernel_commands(CLI::App& app, Commands& commands);
void add_web_commands(CLI::App& app, Commands& commands);

}  // namespace shadowbench::service
