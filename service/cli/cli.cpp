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

constexpr const char* examples = R"(Examples:
  shadowbench run scenarios/quickstart.json
  shadowbench run scenarios/hard --verdicts results/stability.md
  shadowbench run hairball --only deep --only avsm --set rays.samples_per_pixel=64 --out hair64
  shadowbench render quickstart --size 512x384 --out pictures
  shadowbench report results/runs/quickstart --images results/images/quickstart
  shadowbench validate smoke_vdb --data ~/volumes
  shadowbench export quickstart --technique deep:tolerance=0.02 --out hair.dsm
  shadowbench inspect hair.dsm
  shadowbench list techniques
  shadowbench reproduce lokovic2000 --quick
  shadowbench compare nightly/monday nightly/tuesday --markdown verdict.md
  shadowbench ab old/shadowbench build/release/shadowbench hairball --only deep
  shadowbench ab old/kernels build/release/kernels --kernels ^compress/
  shadowbench instructions --filter ^compress/ --out counts.json
  shadowbench history results/nightly
  shadowbench serve --data ~/volumes --port 8080
  shadowbench submit quickstart --server http://127.0.0.1:8080 --wait
  shadowbench curve functions.txt --technique deep:tolerance=0.01 --technique avsm:nodes=8 --json
SCENARIO is a file, or the name of one in ./scenarios, in the folders of $SHADOWBENCH_SCENARIOS or among those installed with the program; for run also a folder.
Results go to results/ in the current folder, unless --out names another.
Exit codes: 0 ok; 1 slower (compare, ab); 2 a technique broke what it promises, or something is larger, less accurate or missing (compare, ab); 64 wrong usage; 65 bad input; 66 no such file; 70 internal fault; 74 input or output failed.)";

int report(std::ostream& err, ErrorCode code, std::string message) {
    std::replace_if(
        message.begin(), message.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    err << "shadowbench: " << message << "\n";
    return static_cast<int>(code);
}

// What CLI11 says of wrong arguments, but for an unknown command, which it calls a missing one.
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
    const results::Program build = results::this_program();
    CLI::App app("Shadow-map techniques held to one scene, one oracle and one clock.", "shadowbench");
    app.set_version_flag("--version", fmt::format("shadowbench {} ({}, {}, {})", build.version, build.commit,
                                                  build.compiler, build.build_type));
    app.require_subcommand(1);
    app.footer(examples);
    Commands commands;
    add_measuring_commands(app, commands);
    add_gate_commands(app, commands);
    add_kernel_commands(app, commands);
    add_job_commands(app, commands);
    add_server_commands(app, commands);
    add_web_commands(app, commands);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error, out, err);
        return report(err, ErrorCode::usage, usage_message(app, argc, argv, error));
    }
    for (const Command& command : commands)
        if (command.app->parsed()) return command.run(out, err);
    return 0;
}

}  // namespace

int cli_main(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
    try {
        const int code = parse_and_run(argc, argv, out, err);
        out.flush();
        if (!out) return report(err, ErrorCode::io, "standard output: cannot write");
        return code;
    } catch (const base::Error& error) {
        return report(err, error.code(), error.what());
    } catch (const Interrupted& interrupted) {
        // Its caller shall see that a signal ended it, but only now that temporary files are gone.
        std::signal(interrupted.signal, SIG_DFL);
        std::raise(interrupted.signal);
        return 128 + interrupted.signal;
    } catch (const std::bad_alloc&) {
        return report(err, ErrorCode::internal, "out of memory; a smaller map or --memory-limit may help");
    } catch (const std::exception& error) {
        return report(err, ErrorCode::internal, std::string("internal fault: ") + error.what());
    }
}

}  // namespace shadowbench::service
