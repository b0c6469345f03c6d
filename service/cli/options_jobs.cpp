#include <memory>
#include <ostream>

#include <CLI/CLI.hpp>

#include "service/cli/job_process_command.h"
#include "service/cli/options.h"

namespace shadowbench::service {

// Not in --help: the server runs it.
void add_job_commands(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<JobProcessArguments>();
    CLI::App* job = app.add_subcommand(
        "job", "Run FOLDER/scenario.json, or find what FOLDER/recommend.json asks, as a job of a server");
    job->group("");
    job->add_option("FOLDER", arguments->folder, "Folder of these files; the results go there too")->required();
    job->add_option("--data", arguments->data, "Look for data only in these folders");
    job->add_option("--memory-limit", arguments->memory_limit,
                    "GiB of memory. A scenario that certainly needs more is refused")
        ->check(CLI::Range(0.001, 1e6))
        ->capture_default_str();
    add_server_library_options(*job, arguments->libraries);
    job->add_flag("!--no-pictures", arguments->pictures, "Measure, but render no pictures");
    commands.push_back(
        {job, [arguments](std::ostream& out, std::ostream&) { return job_process_command(*arguments, out) ? 0 : 2; }});
}

}  // namespace shadowbench::service
