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

}  // namespace shadowbench::service
