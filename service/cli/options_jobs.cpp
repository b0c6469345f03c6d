#include <memory>
#include <ostream>

#include <CLI/CLI.hpp>

#include "service/cli/job_process_command.h"
#include "service/cli/options.h"

namespace shadowbench::service {

// Hidden: the server runs it, and nobody types it.
void add_job_commands(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<JobProcessArguments>();
    CLI::App* job = app.add_subcommand("job", "Run FOLDER/scenario.json as a job of a server");
    job->group("");
    job->add_option("FOLDER", arguments->folder, "Where the scenario is and the results go")->required();
    job->add_option("--data", arguments->data, "The folders to look for data in, and no others");
    job->add_option("--memory-limit", arguments->memory_limit, "GiB; what surely needs more is refused")
        ->check(CLI::Range(0.001, 1e6))
        ->capture_default_str();
    job->add_flag("!--no-pictures", arguments->pictures, "Measure alone");
    commands.push_back(
        {job, [arguments](std::ostream& out, std::ostream&) { return job_process_command(*arguments, out) ? 0 : 2; }});
}

}  // namespace shadowbench::service
