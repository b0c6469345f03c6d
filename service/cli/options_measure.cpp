#include <cmath>
#include <memory>
#include <ostream>
#include <string>

#include <CLI/CLI.hpp>

#include "service/cli/commands.h"
#include "service/cli/options.h"
#include "service/cli/sweep_commands.h"

namespace shadowbench::service {

void repeatable(CLI::Option* option) {
    option->allow_extra_args(false);
}

void set_help(CLI::App& command, const char* group, std::initializer_list<const char*> examples,
              const std::string& notes) {
    command.group(group);
    std::string footer = examples.size() == 1 ? "Example:" : "Examples:";
    for (const char* example : examples) footer += std::string("\n  shadowbench ") + example;
    command.footer(footer + (notes.empty() ? "" : "\n") + notes);
}

namespace {

// CLI::Range accepts NaN.
CLI::Validator in_range(double least, double most) {
    const CLI::Range range(least, most);
    return {[range](std::string& text) {
                double value = 0.0;
                if (CLI::detail::lexical_cast(text, value) && std::isnan(value))
                    return "Value " + text + " is not a number";
                return range(text);
            },
            range.get_description()};
}

}  // namespace

void add_job_options(CLI::App& command, JobArguments& arguments) {
    repeatable(command.add_option("--set", arguments.set,
                                  "path=value: change one value of the scenario, as in rays.samples_per_pixel=64 or "
                                  "/techniques/0/tolerance=0.01. A sweep over that value is dropped"));
    repeatable(
        command.add_option("--data", arguments.data,
                           "Look for data in this folder first, then in $SHADOWBENCH_DATA, the scenario's folder, its "
                           "data/, and scenarios/data"));
    command
        .add_option("--threads", arguments.threads,
                    "Threads; 0: one for each processor. Times are always measured on one thread")
        ->check(CLI::Range(0, 4096));
    command
        .add_option("--memory-limit", arguments.memory_limit,
                    "GiB of memory. A scenario that certainly needs more is refused")
        ->check(in_range(0.001, 1e6))
        ->capture_default_str();
    add_library_options(command, arguments.libraries);
}

void add_library_options(CLI::App& command, LibraryArguments& libraries) {
    CLI::Option* files = command.add_option(
        "--technique-library", libraries.files,
        "Load techniques from this shared library, made with shadowbench_technique.h. They are then techniques as all "
        "others; a fault of the library fails only their rows");
    repeatable(files);
    CLI::Option* isolate =
        command
            .add_flag(
                "--isolate", libraries.isolate,
                "Run each map of these techniques in a process of its own, so that not even a crash or an endless "
                "loop ends the command. Their times then hold the way there and back")
            ->needs(files);
    command.add_option("--call-seconds", libraries.call_seconds, "With --isolate: seconds that one call may take")
        ->needs(isolate)
        ->check(in_range(0.01, 1e6))
        ->capture_default_str();
}

void add_server_library_options(CLI::App& command, LibraryArguments& libraries) {
    add_library_options(command, libraries);
    repeatable(command.add_option("--unusable-library", libraries.unusable,
                                  "FILE, a line break and a reason: a library whose row fails without being opened"));
}

void add_folder_option(CLI::App& command, std::string& folder, const char* text) {
    command.add_option("--out", folder, text)->check([](const std::string& name) {
        return std::string(name.empty() ? "the name of the folder is empty" : "");
    });
}

void add_output_options(CLI::App& command, OutputArguments& arguments) {
    command.add_flag("--wide", arguments.wide, "Show all columns of the table, however long its lines become");
    command
        .add_flag("--json", arguments.json,
                  "Print what result.json holds, and nothing else; of several scenarios or a folder an array")
        ->excludes("--wide");
    command
        .add_flag("--csv", arguments.csv,
                  "Print what result.csv holds, and nothing else; of several scenarios under one header")
        ->excludes("--wide")
        ->excludes("--json");
    command.add_flag("--quiet", arguments.quiet, "Show no progress, and print nothing but errors and --json or --csv");
}

void add_only_option(CLI::App& command, JobArguments& arguments) {
    repeatable(command.add_option("--only", arguments.only, "Use only techniques of this type"));
}

namespace {

void add_scenario_options(CLI::App& command, ScenarioArguments& arguments) {
    command.add_option("SCENARIO", arguments.scenario, "A scenario file, or the name of one")->required();
    add_job_options(command, arguments);
}

void add_run(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<RunArguments>();
    CLI::App* run = app.add_subcommand("run", "Measure scenarios: print a table, write result.json and result.csv");
    set_help(
        *run, command_groups::measure,
        {"run quickstart --pictures",
         "run hairball --only deep --only avsm --set rays.samples_per_pixel=64 --out hair64",
         "run scenarios/hard --verdicts results/stability.md"},
        "The table is as wide as the terminal, or as $COLUMNS says. It has colours on a terminal, unless $NO_COLOR "
        "is set.\n"
        "Four machines share a sweep if each runs one part, --shard 0/4 to --shard 3/4, with --out sweep.\n"
        "Then shadowbench merge sweep makes one result of the parts.\n"
        "Exit codes: 0; 2 a technique broke a promise; others as in shadowbench --help.");
    run->add_option("SCENARIO", arguments->scenarios,
                    "Scenario files, their names, or folders (every *.json directly in the folder). All are checked "
                    "before the first runs")
        ->required();
    add_job_options(*run, *arguments);
    add_only_option(*run, *arguments);
    add_folder_option(*run, arguments->out,
                      "Folder of the results [results/runs/<scenario name>, in the current folder]. Each of several "
                      "scenarios gets the folder DIR/<scenario name>");
    run->add_option("--verdicts", arguments->verdicts,
                    "Markdown file with a verdict per scenario and technique [for several scenarios or a folder: "
                    "verdicts.md in the folder of the results]")
        ->check(
            [](const std::string& name) { return std::string(name.empty() ? "the name of the file is empty" : ""); });
    add_output_options(*run, arguments->output);
    run->add_flag("--pictures", arguments->pictures,
                  "Then draw the camera's view as render does, of the first value of each sweep, into images/ in the "
                  "folder of the results");
    run->add_option("--shard", arguments->shard,
                    "i/n: measure only part i of n, counted from 0, of the cells (a cell is one variant with one "
                    "light), and write each cell to DIR/cells. Cells that are there are skipped, so the same command "
                    "continues. Merge them with shadowbench merge DIR")
        ->check([](const std::string& part) { return std::string(part.empty() ? "expected i/n, as in 0/4" : ""); })
        ->needs("--out")
        ->excludes("--verdicts")
        ->excludes("--pictures")
        ->excludes("--wide")
        ->excludes("--json")
        ->excludes("--csv");
    commands.push_back({run, [arguments](std::ostream& out, std::ostream& err) {
                            const auto command = arguments->shard.empty() ? run_command : shard_command;
                            return command(*arguments, out, err) ? 0 : promise_broken;
                        }});
}

void add_render(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<RenderArguments>();
    CLI::App* render = app.add_subcommand("render", "Render the camera's view with every technique's shadows");
    set_help(*render, command_groups::measure,
             {"render quickstart --size 1024x768 --out pictures", "render hairball --only deep --view-rays 4"},
             "Writes EXR and PNG pictures, and images.json, which lists them.");
    add_scenario_options(*render, *arguments);
    add_only_option(*render, *arguments);
    add_folder_option(*render, arguments->out,
                      "Folder of the pictures [results/images/<scenario name>, in the current folder]");
    render->add_option("--size", arguments->size,
                       "WIDTHxHEIGHT in pixels [the scenario's own, enlarged to a width of 512]");
    render
        ->add_option("--view-rays", arguments->rays_per_side,
                     "N x N view rays per pixel, for smooth edges and hair [2]")
        ->check(CLI::Range(1, 8));
    render
        ->add_option("--media-lookups", arguments->media_lookups,
                     "Lookups per view ray, over all media that it crosses [64]")
        ->check(CLI::Range(1, 256));
    commands.push_back({render, [arguments](std::ostream& out, std::ostream& err) {
                            return render_command(*arguments, out, err) ? 0 : promise_broken;
                        }});
}

void add_validate(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<ScenarioArguments>();
    CLI::App* validate = app.add_subcommand("validate", "Check a scenario and its files without running it");
    set_help(*validate, command_groups::measure,
             {"validate quickstart --set rays.resolution=1024", "validate smoke_vdb --data ~/volumes"});
    add_scenario_options(*validate, *arguments);
    add_only_option(*validate, *arguments);
    commands.push_back({validate, [arguments](std::ostream& out, std::ostream& err) {
                            validate_command(*arguments, out, err);
                            return 0;
                        }});
}

void add_export(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<ExportArguments>();
    CLI::App* exported = app.add_subcommand("export", "Write one light's map, or its light rays, as a file");
    set_help(*exported, command_groups::files,
             {"export quickstart --technique deep:tolerance=0.02 --out hair.dsm",
              "export quickstart --technique avsm:nodes=8 --light 0 --out map.exr",
              "export quickstart --rays --out rays.exr"});
    add_scenario_options(*exported, *arguments);
    exported
        ->add_option("--out", arguments->out,
                     "FILE.exr: a deep OpenEXR image, for every technique that stores functions; FILE.dsm: a tiled "
                     "deep shadow map, only for technique deep")
        ->required();
    CLI::Option* technique =
        exported->add_option("--technique", arguments->technique, "id:name=value,name=value")->capture_default_str();
    exported->add_flag("--rays", arguments->rays, "Write the captured light rays instead of a technique's map")
        ->excludes(technique);
    exported->add_option("--light", arguments->light, "A light's name, or its number, from 0 [the first light]");
    exported->add_option("--tile", arguments->tile, "Side of a tile of FILE.dsm, in pixels")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    commands.push_back({exported, [arguments](std::ostream& out, std::ostream& err) {
                            export_command(*arguments, out, err);
                            return 0;
                        }});
}

void add_list(CLI::App& app, Commands& commands) {
    struct ListArguments {
        std::string what;
        LibraryArguments libraries;
    };
    const auto arguments = std::make_shared<ListArguments>();
    CLI::App* list = app.add_subcommand("list", "List the techniques with their parameters, or the scenarios");
    set_help(*list, command_groups::measure,
             {"list techniques", "list scenarios", "list techniques --technique-library ./libstairs.so"});
    list->add_option("WHAT", arguments->what, "techniques or scenarios")
        ->required()
        ->check(CLI::IsMember({"techniques", "scenarios"}));
    add_library_options(*list, arguments->libraries);
    commands.push_back({list, [arguments](std::ostream& out, std::ostream&) {
                            if (arguments->what == "techniques")
                                list_techniques(arguments->libraries, out);
                            else
                                list_scenarios(out);
                            return 0;
                        }});
}

void add_curve(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<CurveArguments>();
    CLI::App* curve = app.add_subcommand("curve", "Compress visibility functions from a text file");
    set_help(*curve, command_groups::measure,
             {"curve functions.txt --technique deep:tolerance=0.01 --technique avsm:nodes=8 --json",
              "curve functions.txt --technique deep --dump stored.txt"},
             "Prints the nodes, bytes, errors and times of each technique.");
    curve
        ->add_option("FUNCTIONS", arguments->functions,
                     "Text file of records: a line n, then n lines `z T`. z does not decrease; T is in [0, 1] and does "
                     "not increase")
        ->required();
    repeatable(curve->add_option("--technique", arguments->techniques,
                                 "id:name=value,name=value [deep:tolerance=0.02 and avsm:nodes=8]"));
    curve->add_option("--dump", arguments->dump,
                      "Write the stored functions to this file, in the same format; for several techniques to "
                      "FILE.1-<id>, FILE.2-<id>, ...");
    curve->add_flag("--json", arguments->json, "Print JSON instead of a table");
    curve->add_option("--repetitions", arguments->repetitions, "Timed passes")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    commands.push_back({curve, [arguments](std::ostream& out, std::ostream&) {
                            if (arguments->techniques.empty())
                                arguments->techniques = {"deep:tolerance=0.02", "avsm:nodes=8"};
                            curve_command(*arguments, out);
                            return 0;
                        }});
}

void add_reproduce(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<ReproduceArguments>();
    CLI::App* reproduce =
        app.add_subcommand("reproduce", "Measure the claims of the papers again, with a verdict each");
    set_help(*reproduce, command_groups::measure, {"reproduce lokovic2000 --quick", "reproduce all --out results"});
    reproduce->add_option("PAPER", arguments->paper, "reeves1987, lokovic2000, pagot2004, volume, salvi2010, or all")
        ->capture_default_str();
    reproduce->add_option("--out", arguments->out,
                          "Folder of the report; its plots go to plots/ there [results, in the current folder]");
    repeatable(reproduce->add_option("--data", arguments->data, "Look for data in this folder first"));
    reproduce->add_flag("--quick", arguments->quick,
                        "Smaller sizes: all papers in under five minutes. The report says so");
    reproduce
        ->add_option("--threads", arguments->threads,
                     "Threads; 0: one for each processor. Times are always measured on one thread")
        ->check(CLI::Range(0, 4096));
    commands.push_back({reproduce, [arguments](std::ostream& out, std::ostream& err) {
                            reproduce_command(*arguments, out, err);
                            return 0;
                        }});
}

}  // namespace

void add_measuring_commands(CLI::App& app, Commands& commands) {
    for (const auto add : {add_run, add_sweep, add_merge, add_recommend, add_render, add_validate, add_new, add_inspect,
                           add_export, add_list, add_curve, add_reproduce})
        add(app, commands);
}

}  // namespace shadowbench::service
