#include "service/cli/cli.h"

#include <algorithm>
#include <new>
#include <ostream>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/error.h"
#include "bench/build_info.h"
#include "service/cli/commands.h"

namespace shadowbench::service {
namespace {

using base::ErrorCode;

constexpr int promise_broken = 2;  // less accurate than it says

constexpr const char* examples = R"(Examples:
  shadowbench run scenarios/quickstart.json
  shadowbench run scenarios/hard --verdicts results/stability.md
  shadowbench run hairball --only deep --only avsm --set rays.samples_per_pixel=64 --out hair64
  shadowbench render quickstart --size 512x384 --out pictures
  shadowbench validate smoke_vdb --data ~/volumes
  shadowbench export quickstart --technique deep:tolerance=0.02 --out hair.dsm
  shadowbench inspect hair.dsm
  shadowbench list techniques
  shadowbench reproduce lokovic2000 --quick
  shadowbench curve functions.txt --technique deep:tolerance=0.01 --technique avsm:nodes=8 --json
SCENARIO is a file, or the name of one in ./scenarios or in the folders of $SHADOWBENCH_SCENARIOS; for run also a folder.
Exit codes: 0 ok; 2 a technique broke what it promises; 64 wrong usage; 65 bad input; 66 no such file; 70 internal fault; 74 input or output failed.)";

struct Arguments {
    RunArguments run;
    RenderArguments render;
    ScenarioArguments validate;
    ExportArguments exported;
    std::string inspect;
    std::string list;
    CurveArguments curve;
    ReproduceArguments reproduce;
};

// One value an option, as often as the option is given: a following positional argument stays one.
void repeatable(CLI::Option* option) {
    option->allow_extra_args(false);
}

void add_job_options(CLI::App& command, JobArguments& arguments) {
    repeatable(command.add_option("--set", arguments.set,
                                  "path=value: change one value of the scenario, as in rays.samples_per_pixel=64 or "
                                  "/techniques/0/tolerance=0.01; a sweep over it is dropped"));
    repeatable(command.add_option("--data", arguments.data,
                                  "A folder to look for data in; before $SHADOWBENCH_DATA, the scenario's folder, its "
                                  "data/, scenarios/data and ../shared/data"));
    command.add_option("--threads", arguments.threads, "Threads of capture and checks; 0: all (times are of one)")
        ->check(CLI::Range(0, 4096));
    command.add_option("--memory-limit", arguments.memory_limit, "GiB; what surely needs more is refused")
        ->check(CLI::Range(0.001, 1e6))
        ->capture_default_str();
}

void add_scenario_options(CLI::App& command, ScenarioArguments& arguments) {
    command.add_option("SCENARIO", arguments.scenario, "A scenario file, or its name")->required();
    add_job_options(command, arguments);
}

void add_folder_option(CLI::App& command, std::string& folder, const char* text) {
    command.add_option("--out", folder, text)->check([](const std::string& name) {
        return std::string(name.empty() ? "the folder has no name" : "");
    });
}

void add_only_option(CLI::App& command, JobArguments& arguments) {
    repeatable(command.add_option("--only", arguments.only, "Only techniques of this type"));
}

void add_export_commands(CLI::App& app, Arguments& arguments) {
    CLI::App* exported = app.add_subcommand("export", "Write one light's map, or its light rays, for other programs");
    add_scenario_options(*exported, arguments.exported);
    exported
        ->add_option("--out", arguments.exported.out,
                     "FILE.exr: deep OpenEXR, any technique that stores functions; FILE.dsm: tiled file, deep alone")
        ->required();
    CLI::Option* technique =
        exported->add_option("--technique", arguments.exported.technique, "id:name=value,name=value")
            ->capture_default_str();
    exported->add_flag("--rays", arguments.exported.rays, "The captured light rays instead of a technique's map")
        ->excludes(technique);
    exported->add_option("--light", arguments.exported.light, "A light's name, or its number from 0 on [the first]");
    exported->add_option("--tile", arguments.exported.tile, "Pixels a side of a tile of FILE.dsm")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();

    app.add_subcommand("inspect", "Check a tiled deep shadow map file and tell what it holds")
        ->add_option("FILE", arguments.inspect, "A .dsm file")
        ->required();
}

void add_commands(CLI::App& app, Arguments& arguments) {
    CLI::App* run = app.add_subcommand("run",
                                       "Run scenarios: print a table, write result.json and result.csv; of several "
                                       "also a verdict per technique and scenario");
    run->add_option("SCENARIO", arguments.run.scenarios,
                    "Scenario files, their names, or folders: each *.json directly in one. All are checked before the "
                    "first is run")
        ->required();
    add_job_options(*run, arguments.run);
    add_only_option(*run, arguments.run);
    add_folder_option(*run, arguments.run.out,
                      "Folder of the results [results/runs/<scenario name>]; of several scenarios or a folder, each "
                      "gets DIR/<scenario name> [results/runs/<scenario name>]");
    run->add_option("--verdicts", arguments.run.verdicts,
                    "Markdown file of the verdicts [of several scenarios or a folder: verdicts.md in the folder of "
                    "the results]")
        ->check([](const std::string& name) { return std::string(name.empty() ? "the file has no name" : ""); });

    CLI::App* render = app.add_subcommand(
        "render", "Render what the camera sees through every technique: pictures as EXR and PNG, and images.json");
    add_scenario_options(*render, arguments.render);
    add_only_option(*render, arguments.render);
    add_folder_option(*render, arguments.render.out, "Folder of the pictures [results/images/<scenario name>]");
    render->add_option("--size", arguments.render.size, "WIDTHxHEIGHT in pixels [the scenario's own]");
    render->add_option("--view-rays", arguments.render.rays_per_side, "N x N view rays a pixel: smooth edges and hair")
        ->check(CLI::Range(1, 8))
        ->capture_default_str();
    render
        ->add_option("--media-lookups", arguments.render.media_lookups,
                     "Lookups along a view ray through all media of the scene")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();

    CLI::App* validate = app.add_subcommand("validate", "Check a scenario and its files without running it");
    add_scenario_options(*validate, arguments.validate);
    add_only_option(*validate, arguments.validate);
    add_export_commands(app, arguments);

    CLI::App* list = app.add_subcommand("list", "List the techniques with their parameters, or the scenarios");
    list->add_option("WHAT", arguments.list, "techniques or scenarios")
        ->required()
        ->check(CLI::IsMember({"techniques", "scenarios"}));

    CLI::App* curve = app.add_subcommand("curve", "Store given functions of depth: nodes, bytes, errors, times");
    curve
        ->add_option("FUNCTIONS", arguments.curve.functions,
                     "Text file of records: a line n, then n lines `z T`; z non-decreasing, T non-increasing in [0, 1]")
        ->required();
    repeatable(curve->add_option("--technique", arguments.curve.techniques,
                                 "id:name=value,name=value [deep:tolerance=0.02 and avsm:nodes=8]"));
    curve->add_option("--dump", arguments.curve.dump,
                      "Write the stored functions here in the same format; with several techniques, to "
                      "FILE.1-<id>, FILE.2-<id>, ...");
    curve->add_flag("--json", arguments.curve.json, "Print JSON instead of a table");
    curve->add_option("--repetitions", arguments.curve.repetitions, "Timed passes")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
}

void add_reproduce(CLI::App& app, ReproduceArguments& arguments) {
    CLI::App* reproduce =
        app.add_subcommand("reproduce", "Measure the claims of the papers again: a report with a verdict a claim");
    reproduce->add_option("PAPER", arguments.paper, "reeves1987, lokovic2000, pagot2004, volume, salvi2010, or all")
        ->capture_default_str();
    reproduce->add_option("--out", arguments.out, "Folder of the report, its plots in plots/ [results]");
    repeatable(reproduce->add_option("--data", arguments.data, "A folder to look for data in"));
    reproduce->add_flag("--quick", arguments.quick, "Smaller sizes, under five minutes for all; marked as such");
    reproduce->add_option("--threads", arguments.threads, "Threads of capture and checks; 0: all (times are of one)")
        ->check(CLI::Range(0, 4096));
}

// The exit code.
int dispatch(const CLI::App& app, Arguments& arguments, std::ostream& out, std::ostream& err) {
    if (app.got_subcommand("run") && !run_command(arguments.run, out, err)) return promise_broken;
    if (app.got_subcommand("render") && !render_command(arguments.render, out, err)) return promise_broken;
    if (app.got_subcommand("validate")) validate_command(arguments.validate, out);
    if (app.got_subcommand("export")) export_command(arguments.exported, out, err);
    if (app.got_subcommand("inspect")) inspect_command(arguments.inspect, out);
    if (app.got_subcommand("list")) {
        if (arguments.list == "techniques")
            list_techniques(out);
        else
            list_scenarios(out);
    }
    if (app.got_subcommand("reproduce")) reproduce_command(arguments.reproduce, out, err);
    if (app.got_subcommand("curve")) {
        if (arguments.curve.techniques.empty()) arguments.curve.techniques = {"deep:tolerance=0.02", "avsm:nodes=8"};
        curve_command(arguments.curve, out);
    }
    return 0;
}

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
        for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
            names += ", " + command->get_name();
        return fmt::format("unknown command \"{}\"; there are: {} (see shadowbench --help)", argv[1], names.substr(2));
    }
    return std::string(error.what()) + " (see shadowbench --help)";
}

int parse_and_run(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
    const bench::BuildInfo build = bench::build_info();
    CLI::App app("Shadow-map techniques held to one scene, one oracle and one clock.", "shadowbench");
    app.set_version_flag("--version", fmt::format("shadowbench {} ({}, {}, {})", build.version, build.commit,
                                                  build.compiler, build.build_type));
    app.require_subcommand(1);
    app.footer(examples);
    Arguments arguments;
    add_commands(app, arguments);
    add_reproduce(app, arguments.reproduce);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error, out, err);
        return report(err, ErrorCode::usage, usage_message(app, argc, argv, error));
    }
    return dispatch(app, arguments, out, err);
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
    } catch (const std::bad_alloc&) {
        return report(err, ErrorCode::internal, "out of memory; a smaller map or --memory-limit may help");
    } catch (const std::exception& error) {
        return report(err, ErrorCode::internal, std::string("internal fault: ") + error.what());
    }
}

}  // namespace shadowbench::service
