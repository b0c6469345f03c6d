#include "service/cli/cli.h"

#include <algorithm>
#include <csignal>
#include <new>
#include <ostream>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/error.h"
#include "results/program.h"
#include "service/cli/child.h"
#include "service/cli/options.h"

namespace shadowbench::service {
namespace {

using base::ErrorCode;

constexpr const char* program_notes = R"(Examples:
  shadowbench run quickstart
  shadowbench render quickstart --out pictures
  shadowbench compare nightly/monday nightly/tuesday
  shadowbench serve --data ~/volumes

shadowbench COMMAND --help describes a command and its options.
A SCENARIO is a file, or the name of one in ./scenarios, in the folders of $SHADOWBENCH_SCENARIOS, or among the
scenarios that were installed with the program. Results go to results/ in the current folder, unless --out is given.
Exit codes: 0 success; 1 slower (compare, ab); 2 a technique broke a promise, a cell is missing (merge), or a measure is
larger, less accurate or missing (compare, ab); 64 wrong usage; 65 bad input; 66 no such file; 70 internal fault;
74 input or output failed.)";

// The parser with all commands.
struct CommandLine {
    CLI::App app{"Compares shadow-map techniques on the same scenes, against the same ray-traced reference.",
                 "shadowbench"};
    Commands commands;

    CommandLine() {
        const results::Program build = results::this_program();
        app.set_version_flag("--version", fmt::format("shadowbench {} ({}, {}, {})", build.version, build.commit,
                                                      build.compiler, build.build_type));
        app.require_subcommand(1);
        for (const auto add : {add_measuring_commands, add_web_commands, add_gate_commands, add_kernel_commands,
                               add_server_commands, add_job_commands})
            add(app, commands);
        app.footer(program_notes);  // last: a subcommand takes on the footer that is there when it is added
    }
};

int report(std::ostream& err, ErrorCode code, std::string message) {
    std::replace_if(
        message.begin(), message.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    err << "shadowbench: " << message << "\n";
    return static_cast<int>(code);
}

// CLI11's message, except that it calls an unknown command a missing one.
std::string usage_message(const CLI::App& app, int argc, const char* const* argv, const CLI::ParseError& error) {
    if (app.get_subcommands().empty() && argc > 1 && argv[1][0] != '-') {
        std::string names;
        const auto shown = [](const CLI::App* command) { return !command->get_group().empty(); };
        for (const CLI::App* command : app.get_subcommands(shown)) names += ", " + command->get_name();
        return fmt::format("unknown command \"{}\"; there are: {} (see shadowbench --help)", argv[1], names.substr(2));
    }
    return std::string(error.what()) + " (see shadowbench --help)";
}

int parse_and_run(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
    CommandLine line;
    try {
        line.app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return line.app.exit(error, out, err);
        return report(err, ErrorCode::usage, usage_message(line.app, argc, argv, error));
    }
    for (const Command& command : line.commands)
        if (command.app->parsed()) return command.run(out, err);
    return 0;
}

}  // namespace

std::string usage_fault(int argc, const char* const* argv) {
    CommandLine line;
    try {
        line.app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0) return usage_message(line.app, argc, argv, error);
    }
    return "";
}

int cli_main(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
    try {
        const int code = parse_and_run(argc, argv, out, err);
        out.flush();
        if (!out) return report(err, ErrorCode::io, "standard output: cannot write");
        return code;
    } catch (const base::Error& error) {
        return report(err, error.code(), error.what());
    } catch (const Interrupted& interrupted) {
        // The temporary files are gone. Now the program ends by the signal, so that its caller sees that.
        std::signal(interrupted.signal, SIG_DFL);
        std::raise(interrupted.signal);
        return 128 + interrupted.signal;
    } catch (const std::bad_alloc&) {
        return report(err, ErrorCode::internal, "out of memory; use a smaller map or a lower --memory-limit");
    } catch (const std::exception& error) {
        return report(err, ErrorCode::internal, std::string("internal fault: ") + error.what());
    }
}

}  // namespace shadowbench::service
