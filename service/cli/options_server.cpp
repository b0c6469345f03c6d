#include <memory>
#include <ostream>
#include <string>

#include <CLI/CLI.hpp>

#include "service/cli/options.h"
#include "service/cli/server_commands.h"

namespace shadowbench::service {
namespace {

void add_data(CLI::App& command, std::vector<std::string>& data, const char* text) {
    command.add_option("--data", data, text)->allow_extra_args(false);
}

void add_limits(CLI::App& serve, ServeArguments& a) {
    serve.add_option("--queue", a.queue, "Jobs that may wait")->check(CLI::Range(1, 1'000'000))->capture_default_str();
    serve.add_option("--parallel", a.parallel, "Jobs at a time; more than one disturb each other's times")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    serve.add_option("--job-seconds", a.job_seconds, "Of one job; then it is killed")
        ->check(CLI::Range(1.0, 1e7))
        ->capture_default_str();
    serve.add_option("--job-memory", a.job_memory, "GiB a job may take; what surely needs more is refused")
        ->check(CLI::Range(0.1, 1e5))
        ->capture_default_str();
    serve.add_option("--estimate", a.estimate_seconds, "Seconds; what is guessed to run longer is refused")
        ->check(CLI::Range(0.0, 1e9))
        ->capture_default_str();
    serve.add_option("--resolution", a.resolution, "Map pixels a side that are taken")
        ->check(CLI::Range(1, 65536))
        ->capture_default_str();
    serve.add_option("--samples", a.samples, "Rays a pixel that are taken, of maps and of the truth")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    serve.add_option("--body", a.body, "MiB of a request")->check(CLI::Range(0.001, 1024.0))->capture_default_str();
    serve.add_option("--workers", a.workers, "Threads that answer")->check(CLI::Range(1, 1024))->capture_default_str();
    serve
        .add_option("--event-clients", a.event_clients, "Clients that may follow events, each with a thread of its own")
        ->check(CLI::Range(0, 4096))
        ->capture_default_str();
}

void add_serve(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<ServeArguments>();
    CLI::App* serve = app.add_subcommand("serve", "Take scenarios over HTTP: jobs, results, a page; until SIGTERM");
    serve->add_option("--host", arguments->host, "Address to listen at; beyond this machine a token is needed")
        ->capture_default_str();
    serve->add_option("--port", arguments->port, "0: any that is free")
        ->check(CLI::Range(0, 65535))
        ->capture_default_str();
    serve->add_option("--port-file", arguments->port_file, "File that the port is written to once it listens");
    serve->add_option("--token-file", arguments->token_file,
                      "File of a token, readable by its owner alone, that every request must bring");
    serve
        ->add_option("--state", arguments->state,
                     "Folder of the jobs and their results: new, empty, or one of a server's")
        ->capture_default_str();
    add_data(*serve, arguments->data, "A folder whose files scenarios may name; without it none");
    serve->add_option("--grace", arguments->grace, "Seconds that jobs have to end when the server stops")
        ->check(CLI::Range(0.0, 3600.0))
        ->capture_default_str();
    add_limits(*serve, *arguments);
    commands.push_back({serve, [arguments](std::ostream& out, std::ostream& err) {
                            serve_command(*arguments, out, err);
                            return 0;
                        }});
}

void add_submit(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<SubmitArguments>();
    CLI::App* submit = app.add_subcommand("submit", "Send a scenario to a server; with --wait print its table");
    submit->add_option("SCENARIO", arguments->scenario, "A scenario file, or its name")->required();
    submit->add_option("--server", arguments->server, "Its URL")->capture_default_str();
    submit->add_option("--token-file", arguments->token_file, "File of the token that the server asks for");
    submit->add_option("--set", arguments->set, "path=value: change one value of the scenario, as for run")
        ->allow_extra_args(false);
    submit->add_flag(
        "--wait", arguments->wait,
        "Wait for the result; exit codes as of run; a server that does not answer is tried again for 60 s");
    submit->add_flag("--fresh", arguments->fresh, "Run it even if there is a result of the same scenario");
    submit->add_flag("--no-pictures", arguments->no_pictures, "Measure alone, render nothing");
    commands.push_back({submit, [arguments](std::ostream& out, std::ostream& err) {
                            return submit_command(*arguments, out, err) ? 0 : promise_broken;
                        }});
}

// What the server asks of a process of its own. Not for people, so --help does not show them.
void add_helpers(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<HelperArguments>();
    CLI::App* examine = app.add_subcommand("examine", "Scenarios on standard input, a line each, checked")->group("");
    add_data(*examine, arguments->data, "A folder whose files scenarios may name");
    commands.push_back({examine, [arguments](std::ostream& out, std::ostream&) {
                            examine_command(*arguments, out);
                            return 0;
                        }});
    CLI::App* curves =
        app.add_subcommand("curves", "A scenario, then pixels, on standard input, a line each: their functions")
            ->group("");
    add_data(*curves, arguments->data, "A folder whose files scenarios may name");
    curves->add_option("--light", arguments->light, "A light's name, or its number from 0 on [the first]");
    curves->add_option("--variant", arguments->variant, "A combination of the sweeps' values, counted from 0");
    commands.push_back({curves, [arguments](std::ostream& out, std::ostream&) {
                            curves_command(*arguments, out);
                            return 0;
                        }});
}

}  // namespace

void add_server_commands(CLI::App& app, Commands& commands) {
    for (const auto add : {add_serve, add_submit, add_helpers}) add(app, commands);
}

}  // namespace shadowbench::service
