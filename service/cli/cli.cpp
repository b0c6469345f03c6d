#include "service/cli/cli.h"

#include <algorithm>
#include <csignal>
#include <cstring>
#include <new>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/error.h"
#include "base/nearest.h"
#include "base/table.h"
#include "results/program.h"
#include "service/cli/child.h"
#include "service/cli/options.h"
#include "service/cli/terminal.h"

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
Exit codes: 0 success; 1 slower (compare, ab); 2 a technique broke a promise (run, sweep, merge, render, baseline,
submit), a cell is missing (sweep, merge), nothing reaches the error (recommend, submit), a kernel answered wrongly
(instructions, baseline), or a measure is larger, less accurate or missing (compare, ab); 64 wrong usage; 65 bad input; 66 no such
file; 70 internal fault; 74 input or output failed.)";

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
                               add_server_commands, add_job_commands, add_help_commands})
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

using Names = std::vector<std::string>;

// The first option that the command does not have, and what the user may have meant by it; empty: it has them all.
struct UnknownOption {
    std::string name, perhaps;
};
UnknownOption unknown_option(const CLI::App& command, int argc, const char* const* argv) {
    Names names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i], option = word.substr(0, word.find('='));
        if (option.size() < 3 || option.compare(0, 2, "--") != 0) continue;
        if (std::find(names.begin(), names.end(), option) == names.end()) return {option, base::perhaps(option, names)};
    }
    return {};
}

// What the user may have meant in a message as of CLI::IsMember: "--measure: rns not in {rms,max}".
std::string near_word(const std::string& message) {
    const std::size_t list = message.find(" not in {"), end = message.find('}', list);
    if (list == std::string::npos || end == std::string::npos) return "";
    const std::size_t first = message.rfind(' ', list - 1) + 1, names_from = list + std::strlen(" not in {");
    Names names;
    std::istringstream words(message.substr(names_from, end - names_from));
    for (std::string name; std::getline(words, name, ',');) names.push_back(name);
    return base::perhaps(message.substr(first, list - first), names);
}

// CLI11's message, except that it calls an unknown command a missing one. It names what a misspelt word may mean.
std::string usage_message(const CLI::App& app, int argc, const char* const* argv, const CLI::ParseError& error) {
    const std::vector<CLI::App*> parsed = app.get_subcommands();
    if (parsed.empty() && argc > 1 && argv[1][0] != '-') {
        Names names;
        const auto shown = [](const CLI::App* command) { return !command->get_group().empty(); };
        for (const CLI::App* command : app.get_subcommands(shown)) names.push_back(command->get_name());
        return fmt::format("unknown command \"{}\"{}; there are: {} (see shadowbench --help)", argv[1],
                           base::perhaps(argv[1], names), fmt::join(names, ", "));
    }
    const std::string message = error.what();
    const auto is = [&](CLI::ExitCodes code) { return error.get_exit_code() == static_cast<int>(code); };
    const UnknownOption unknown = unknown_option(parsed.empty() ? app : *parsed[0], argc, argv);
    std::string more = near_word(message);
    if (is(CLI::ExitCodes::ExtrasError))
        more = unknown.perhaps;
    else if (is(CLI::ExitCodes::RequiredError) && !unknown.name.empty())  // misspelt, it is missing
        more = fmt::format("; there is no {}{}", unknown.name, unknown.perhaps);
    return message + more +
           (parsed.empty() ? " (see shadowbench --help)"
                           : fmt::format(" (see shadowbench {} --help)", parsed[0]->get_name()));
}

constexpr std::size_t help_column = 30;  // where CLI11 begins the texts of options and commands

// A help in lines of this width; its examples are not broken.
std::string help_in_lines(const std::string& help, std::size_t width) {
    std::string result;
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) {
        const bool labelled = width >= help_column + 20 && line.size() > help_column && line.starts_with("  ") &&
                              line[2] != ' ' && line[help_column - 1] == ' ' && line[help_column] != ' ';
        if (line.size() <= width || line.starts_with("  shadowbench ")) {
            result += line + "\n";
        } else if (labelled) {
            std::string text = base::wrapped(std::string(help_column, ' ') + line.substr(help_column), width);
            result += text.replace(0, help_column, line, 0, help_column);
        } else {
            result += base::wrapped(line, width);
        }
    }
    return result;
}

// Of --help and --version.
int print_help(const CLI::App& app, const CLI::ParseError& called, std::ostream& out, std::ostream& err) {
    std::ostringstream help;
    const int code = app.exit(called, help, err);
    out << help_in_lines(help.str(), line_width(out));
    return code;
}

int parse_and_run(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
    CommandLine line;
    try {
        line.app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return print_help(line.app, error, out, err);
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
