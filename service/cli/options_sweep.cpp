#include <memory>
#include <ostream>

#include <CLI/CLI.hpp>

#include "service/cli/options.h"
#include "service/cli/sweep_commands.h"

namespace shadowbench::service {

void add_merge(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<MergeArguments>();
    CLI::App* merge = app.add_subcommand("merge", "Make one result of the cells that run --shard has measured");
    set_help(*merge, command_groups::measure, {"merge sweep", "merge sweep-of-node1 sweep-of-node2 --out result"},
             "Writes what run writes, for every scenario whose cells are all there. Names the cells that are missing,\n"
             "with a command that measures them, and the cells that are there twice. Their measures must agree.\n"
             "Exit codes: 0; 2 a cell is missing, or a technique broke a promise; others as in shadowbench --help.");
    merge
        ->add_option("DIR", arguments->folders,
                     "Folders that run --shard has filled, of one sweep; several if the machines have no common disk")
        ->required();
    add_folder_option(*merge, arguments->out,
                      "Folder of the result [results/runs/<scenario name>, in the current folder]. Each of several "
                      "scenarios gets a folder of its name there");
    add_library_options(*merge, arguments->libraries);
    add_output_options(*merge, arguments->output);
    commands.push_back({merge, [arguments](std::ostream& out, std::ostream& err) {
                            return merge_command(*arguments, out, err) ? 0 : promise_broken;
                        }});
}

void add_sweep(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<SweepArguments>();
    CLI::App* sweep = app.add_subcommand("sweep", "Measure scenarios on many machines, with Slurm or GNU parallel");
    set_help(
        *sweep, command_groups::measure,
        {"sweep hairball --out sweep --nodes 4 --partition long --wait", "sweep hairball --out sweep --print",
         "sweep quickstart hairball --out sweep --engine parallel --ssh node1 --ssh node2"},
        "Machines share DIR and this program's file. Each measures a part, as run --shard i/n --out DIR does; then\n"
        "merge writes DIR/result. DIR/batch has a log of each part, part-<i>.log, and merge.log. Killed parts start\n"
        "again and continue. The same command again shows jobs that still run, or continues where they ended.\n"
        "Exit codes of --wait and of GNU parallel: 0; those of merge; or that of the first part that failed.\n"
        "Without --wait: 0 once Slurm has the jobs.");
    sweep
        ->add_option("SCENARIO", arguments->scenarios,
                     "Scenario files, their names, or folders, as for run. All are checked first")
        ->required();
    add_job_options(*sweep, *arguments);
    add_only_option(*sweep, *arguments);
    add_folder_option(*sweep, arguments->out, "Folder of the cells, the logs and the result");
    sweep->get_option("--out")->required();
    sweep
        ->add_option("--nodes", arguments->nodes,
                     "Machines to share the cells. Each has a part, and a machine to itself [those of the partition, "
                     "as sinfo counts them, or those of --ssh]")
        ->check(CLI::Range(1, 100'000));
    CLI::Option* partition =
        sweep->add_option("--partition", arguments->partition, "Slurm's partition [the default one]");
    sweep
        ->add_option("--engine", arguments->engine,
                     "slurm: an array job, and a job that merges after it. parallel: GNU parallel, here or by ssh")
        ->check(CLI::IsMember({"slurm", "parallel"}))
        ->capture_default_str();
    CLI::Option* ssh = sweep->add_option("--ssh", arguments->ssh,
                                         "With --engine parallel: a machine to use, as ssh takes it. It needs no "
                                         "password, and has the current folder");
    ssh->excludes(partition);
    repeatable(ssh);
    sweep->add_flag("--print", arguments->print, "Print the commands for a shell, and start nothing");
    sweep->add_flag(
        "--wait", arguments->wait,
        "With Slurm: show the progress until all jobs have ended, then the merged tables. Ctrl-C leaves the "
        "jobs running");
    commands.push_back(
        {sweep, [arguments](std::ostream& out, std::ostream& err) { return sweep_command(*arguments, out, err); }});
}

}  // namespace shadowbench::service
