#include <memory>
#include <ostream>
#include <string>

#include <CLI/CLI.hpp>

#include "recommend/request.h"
#include "service/cli/options.h"
#include "service/cli/server_commands.h"
#include "service/http/prefix.h"
#include "service/isolation/host.h"

namespace shadowbench::service {
namespace {

void add_data(CLI::App& command, std::vector<std::string>& data, const char* text) {
    command.add_option("--data", data, text)->allow_extra_args(false);
}

void add_limits(CLI::App& serve, ServeArguments& a) {
    serve.add_option("--queue", a.queue, "Jobs that may wait. More are refused")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    serve.add_option("--parallel", a.parallel, "Jobs that run at a time. More than one disturb each other's times")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    serve.add_option("--job-seconds", a.job_seconds, "Seconds that a job may run before it is killed")
        ->check(CLI::Range(1.0, 1e7))
        ->capture_default_str();
    serve
        .add_option("--job-memory", a.job_memory,
                    "GiB that a job may take. A scenario that certainly needs more is refused")
        ->check(CLI::Range(0.1, 1e5))
        ->capture_default_str();
    serve
        .add_option("--estimate", a.estimate_seconds, "Seconds. A scenario that is estimated to run longer is refused")
        ->check(CLI::Range(0.0, 1e9))
        ->capture_default_str();
    serve.add_option("--resolution", a.resolution, "Largest side of a map, in pixels")
        ->check(CLI::Range(1, 65536))
        ->capture_default_str();
    serve.add_option("--samples", a.samples, "Most rays per pixel, of maps and of the reference")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    serve
        .add_option("--min-free", a.min_free,
                    "MiB that must be free on the disk of --state for a job to start. With less, jobs wait")
        ->check(CLI::Range(0.0, 1e9))
        ->capture_default_str();
    serve.add_option("--body", a.body, "Largest body of a request, in MiB")
        ->check(CLI::Range(0.001, 1024.0))
        ->capture_default_str();
    serve.add_option("--workers", a.workers, "Threads that answer requests")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    serve
        .add_option("--event-clients", a.event_clients, "Clients that may follow events at a time; each takes a thread")
        ->check(CLI::Range(0, 4096))
        ->capture_default_str();
}

void add_retention(CLI::App& serve, ServeArguments& a) {
    serve
        .add_option("--keep-days", a.keep_days, "Remove jobs this many days after they ended, unless pinned [keep all]")
        ->check(CLI::Range(0.0, 1e6));
    serve
        .add_option("--keep-jobs", a.keep_jobs,
                    "Keep this many jobs that have ended, besides pinned ones; remove the others [keep all]")
        ->check(CLI::Range(0, 100'000'000));
    serve
        .add_option("--keep-bytes", a.keep_gib,
                    "GiB that the results of jobs may take, besides pinned ones; remove the oldest [no limit]")
        ->check(CLI::Range(0.0, 1e6));
}

void add_log(CLI::App& serve, ServeArguments& a) {
    serve.add_option("--log-format", a.log_format, "Lines of the log on standard error: text or json")
        ->check(CLI::IsMember({"text", "json"}))
        ->capture_default_str();
    serve
        .add_option("--log-level", a.log_level,
                    "Least level of the log: debug (with requests of monitors), info (with requests and jobs), warning "
                    "or error")
        ->check(CLI::IsMember({"debug", "info", "warning", "error"}))
        ->capture_default_str();
}

// `serve backup` and `serve fsck`.
void add_state_commands(CLI::App& serve, const std::shared_ptr<ServeArguments>& of_serve, Commands& commands) {
    const auto arguments = std::make_shared<StateArguments>();
    // --state may also stand before the name of the command.
    const auto with_state = [arguments, of_serve](const CLI::App* command) {
        if (command->count("--state") == 0) arguments->state = of_serve->state;
        return *arguments;
    };
    const auto add_state = [&](CLI::App& command) {
        command.add_option("--state", arguments->state, "State folder of a server, which may be running")
            ->capture_default_str();
    };
    CLI::App* backup = serve.add_subcommand("backup", "Copy a state folder; the server may be running");
    backup->add_option("DIR", arguments->backup, "New folder, which a server can use with --state")->required();
    add_state(*backup);
    commands.push_back({backup, [with_state, backup](std::ostream& out, std::ostream&) {
                            backup_command(with_state(backup), out);
                            return 0;
                        }});
    CLI::App* fsck = serve.add_subcommand("fsck", "Check a state folder: database, results, and their checksums");
    add_state(*fsck);
    commands.push_back({fsck, [with_state, fsck](std::ostream& out, std::ostream&) {
                            fsck_command(with_state(fsck), out);
                            return 0;
                        }});
}

void add_serve(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<ServeArguments>();
    CLI::App* serve = app.add_subcommand("serve", "Run scenarios that clients send over HTTP; serve their results");
    set_help(*serve, command_groups::serve,
             {"serve", "serve --data ~/volumes --port 8080", "serve --host 0.0.0.0 --token-file token.txt"},
             "With --launcher 'srun --exclusive -N1 -n1' --parallel 4, four nodes of Slurm run the jobs.\nServes the "
             "API, which /openapi.json describes, and a page. SIGTERM and SIGINT stop it.");
    serve
        ->add_option("--host", arguments->host,
                     "Address to listen on. One that other machines can reach needs --token-file")
        ->capture_default_str();
    serve->add_option("--port", arguments->port, "Port to listen on; 0: any free port")
        ->check(CLI::Range(0, 65535))
        ->capture_default_str();
    serve->add_option("--port-file", arguments->port_file, "Write the port to this file once the server listens");
    serve->add_option("--token-file", arguments->token_file,
                      "File with the tokens, one of which every request must carry: lines of TOKEN, or NAME TOKEN "
                      "[queued=N] [running=N] [bytes=N]. Only its owner may be able to read it");
    serve
        ->add_option("--base-path", arguments->base_path,
                     "Where a proxy shows the server below its host, as /lab [the proxy sends X-Forwarded-Prefix]")
        ->check(CLI::Validator(
            [](const std::string& path) {
                return is_prefix(path) ? std::string() : "expected a path such as /lab, without a slash at its end";
            },
            "PATH"));
    serve
        ->add_option("--state", arguments->state,
                     "Folder of the jobs and their results: a new or empty one, or that of an earlier server")
        ->capture_default_str();
    add_data(*serve, arguments->data, "Scenarios may name the files of this folder [no files]");
    serve->add_option(
        "--technique-libraries", arguments->libraries,
        "Load techniques from the shared libraries (*.so) of this folder. Their maps live in processes of their own, "
        "as with run --isolate. Start the server again after a file has changed [none]");
    serve
        ->add_option("--call-seconds", arguments->call_seconds,
                     "Seconds that one call of a technique from outside may take")
        ->check(CLI::Range(0.01, 1e6))
        ->capture_default_str();
    serve->add_option("--grace", arguments->grace, "Seconds that running jobs may take to finish when the server stops")
        ->check(CLI::Range(0.0, 3600.0))
        ->capture_default_str();
    serve->add_option(
        "--launcher", arguments->launcher,
        "Start jobs through this command, on machines that share the state folder, the --data folders and "
        "this program's file, as in 'srun --exclusive -N1 -n1'. Use --parallel for as many jobs as there "
        "are machines");
    add_limits(*serve, *arguments);
    add_retention(*serve, *arguments);
    add_log(*serve, *arguments);
    add_state_commands(*serve, arguments, commands);
    commands.push_back({serve, [arguments](std::ostream& out, std::ostream& err) {
                            serve_command(*arguments, out, err);
                            return 0;
                        }});
}

void add_submit(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<SubmitArguments>();
    CLI::App* submit = app.add_subcommand("submit", "Send a scenario to a server");
    set_help(*submit, command_groups::serve,
             {"submit quickstart --server http://127.0.0.1:8080 --wait",
              "submit hairball --set rays.resolution=256 --fresh --wait", "submit quickstart --recommend 0.02 --wait"});
    submit->add_option("SCENARIO", arguments->scenario, "A scenario file, or the name of one")->required();
    submit->add_option("--server", arguments->server, "URL of the server")->capture_default_str();
    submit->add_option("--token-file", arguments->token_file, "File with the token of the server");
    submit
        ->add_option("--cacert", arguments->cacert,
                     "File with the certificates to trust (PEM) for a server with https [those of the system]")
        ->check(CLI::ExistingFile);
    submit->add_option("--set", arguments->set, "path=value: change one value of the scenario, as for run")
        ->allow_extra_args(false);
    submit->add_option("--label", arguments->labels, "A label of the job, to find it by; may be repeated")
        ->allow_extra_args(false);
    submit->add_option("--priority", arguments->priority, "Of your jobs, those of the highest priority run first")
        ->check(CLI::Range(-100, 100))
        ->capture_default_str();
    submit->add_flag("--wait", arguments->wait,
                     "Wait for the result and print its table or answer, with the exit codes of run or recommend. A "
                     "server that does not answer is tried "
                     "again for 60 s");
    submit->add_flag("--fresh", arguments->fresh, "Run the scenario even if the server has a result of it");
    CLI::Option* no_pictures =
        submit->add_flag("--no-pictures", arguments->no_pictures, "Measure, but render no pictures");
    CLI::Option* recommend =
        submit
            ->add_option("--recommend", arguments->recommend,
                         "Instead of running it, find the cheapest technique and settings whose RMS error is at most "
                         "this, as recommend --error does")
            ->excludes(no_pictures);
    check_error(recommend);
    submit->add_option("--budget", arguments->budget, "With --recommend: its time, as in 90s, 5min or 1h [5min]")
        ->needs(recommend);
    commands.push_back({submit, [arguments](std::ostream& out, std::ostream& err) {
                            return submit_command(*arguments, out, err) ? 0 : promise_broken;
                        }});
}

// Not in --help: the server runs these as child processes.
void add_helpers(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<HelperArguments>();
    CLI::App* examine = app.add_subcommand("examine", "Check scenarios, one per line of standard input")->group("");
    add_data(*examine, arguments->data, "Scenarios may name the files of this folder");
    examine->add_option("--pace", arguments->pace, "Seconds here for one of the machine that estimates are made for");
    add_server_library_options(*examine, arguments->libraries);
    commands.push_back({examine, [arguments](std::ostream& out, std::ostream&) {
                            examine_command(*arguments, out);
                            return 0;
                        }});
    const auto guarded = std::make_shared<GuardArguments>();
    CLI::App* guard = app.add_subcommand("guard", "Run a job where a launcher has started it")->group("");
    guard->add_option("--seconds", guarded->seconds, "Seconds that it may run");
    guard->add_option("--silence", guarded->silence, "Seconds without a sign of life of the server that end it");
    guard->add_option("--memory", guarded->memory, "Bytes that it may take");
    guard->add_option("COMMAND", guarded->words, "The program and its arguments")->required();
    commands.push_back({guard, [guarded, guard](std::ostream& out, std::ostream& err) {
                            guard_command(*guarded, out, err);
                            return 0;
                        }});
    CLI::App* curves =
        app.add_subcommand("curves", "Read a scenario, then pixels, one per line; write their visibility functions")
            ->group("");
    add_data(*curves, arguments->data, "Scenarios may name the files of this folder");
    add_server_library_options(*curves, arguments->libraries);
    curves->add_option("--light", arguments->light, "A light's name, or its number, from 0 [the first light]");
    curves->add_option("--variant", arguments->variant, "Number of a combination of the sweeps' values, from 0");
    commands.push_back({curves, [arguments](std::ostream& out, std::ostream&) {
                            curves_command(*arguments, out);
                            return 0;
                        }});
}

// Not in --help: --isolate runs it, for each map.
void add_technique_host(CLI::App& app, Commands& commands) {
    const auto library = std::make_shared<std::string>(), hash = std::make_shared<std::string>();
    CLI::App* host = app.add_subcommand("technique-host", "Serve a library of techniques on standard input, a socket");
    host->group("");
    host->add_option("LIBRARY", *library)->required();
    host->add_option("HASH", *hash, "Of the library, which is not opened if it has another one")->required();
    commands.push_back({host, [library, hash](std::ostream&, std::ostream&) {
                            host_techniques(*library, *hash);
                            return 0;
                        }});
}

}  // namespace

void add_server_commands(CLI::App& app, Commands& commands) {
    for (const auto add : {add_serve, add_submit, add_helpers, add_technique_host}) add(app, commands);
}

}  // namespace shadowbench::service
