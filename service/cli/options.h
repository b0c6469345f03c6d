// The commands with their options, a file for each group of the program's --help.
#pragma once

#include <functional>
#include <initializer_list>
#include <iosfwd>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace shadowbench::service {

struct JobArguments;
struct LibraryArguments;
struct OutputArguments;

struct Command {
    CLI::App* app;                                                 // the subcommand, with its options
    std::function<int(std::ostream& out, std::ostream& err)> run;  // the exit code; throws base::Error
};
using Commands = std::vector<Command>;

constexpr int promise_broken = 2;  // exit code: a technique is less accurate than it promises

// The option may be given several times, with one value each time. A positional argument may follow it.
void repeatable(CLI::Option* option);

// Groups of subcommands, as the program's --help heads them, in its order.
namespace command_groups {
inline constexpr const char *measure = "Measure scenarios", *files = "Read and write files",
                            *compare = "Compare results over time", *serve = "Run a server";
}

// Puts a subcommand into a group, and its examples, each a line of arguments that begins with its name, at the end of
// its --help. `notes` follow them.
void set_help(CLI::App& command, const char* group, std::initializer_list<const char*> examples,
              const std::string& notes = "");

// Options that several commands share; arguments and folder must outlive the parsing.
void add_job_options(CLI::App& command, JobArguments& arguments);
void add_library_options(CLI::App& command, LibraryArguments& libraries);
// And what only a server passes on.
void add_server_library_options(CLI::App& command, LibraryArguments& libraries);
void add_only_option(CLI::App& command, JobArguments& arguments);
void add_output_options(CLI::App& command, OutputArguments& arguments);
// Its value must be an error that a recommendation may be asked for.
void check_error(CLI::Option* option);
void add_folder_option(CLI::App& command, std::string& folder, const char* text);

// Each adds its subcommand, as the functions below do for theirs.
void add_recommend(CLI::App& app, Commands& commands);
void add_merge(CLI::App& app, Commands& commands);
void add_sweep(CLI::App& app, Commands& commands);
void add_inspect(CLI::App& app, Commands& commands);
void add_new(CLI::App& app, Commands& commands);

// Each adds its subcommands to the application, and to `commands` what they run once the arguments are parsed.
void add_measuring_commands(CLI::App& app, Commands& commands);
void add_job_commands(CLI::App& app, Commands& commands);
void add_server_commands(CLI::App& app, Commands& commands);
void add_gate_commands(CLI::App& app, Commands& commands);
void add_kernel_commands(CLI::App& app, Commands& commands);
void add_web_commands(CLI::App& app, Commands& commands);
void add_help_commands(CLI::App& app, Commands& commands);

}  // namespace shadowbench::service
