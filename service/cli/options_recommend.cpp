#include <charconv>
#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/error.h"
#include "recommend/request.h"
#include "service/cli/options.h"
#include "service/cli/recommend_command.h"

namespace shadowbench::service {
namespace {

// What says how to measure, where nothing is measured.
void refuse_without_measuring(const CLI::App& recommend, const RecommendArguments& arguments) {
    if (arguments.from.empty() || !arguments.beside.empty()) return;
    for (const char* option : {"--budget", "--set", "--threads"})
        if (recommend.count(option) > 0)
            throw base::Error(base::ErrorCode::usage, option, "nothing is measured with --from, unless with --beside");
}

std::string error_fault(const std::string& text) {
    double error = 0.0;
    const char* end = text.data() + text.size();
    const auto [rest, fault] = std::from_chars(text.data(), end, error);
    if (fault != std::errc() || rest != end || !std::isfinite(error))
        return fmt::format("\"{}\" is not a number; write one as 0.02", text);
    if (error >= recommend::least_error && error <= recommend::most_error) return "";
    return fmt::format("{} is not from {} to {}", text, recommend::least_error, recommend::most_error);
}

}  // namespace

void check_error(CLI::Option* option) {
    option->check(CLI::Validator([](std::string& text) { return error_fault(text); },
                                 fmt::format("FLOAT in [{} - {}]", recommend::least_error, recommend::most_error)));
}

void add_recommend(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<RecommendArguments>();
    CLI::App* recommend = app.add_subcommand("recommend", "Find the cheapest technique and settings for an error");
    set_help(
        *recommend, command_groups::measure,
        {"recommend quickstart --error 0.02 --budget 2min",
         "recommend hairball --error 0.01 --measure p99 --cheapest lookup --at-most bytes=4MiB",
         "recommend --from results/recommendations/quickstart --beside results/runs/quickstart --error 0.05"},
        "All maps answer the same lookups over the same footprints, whatever their resolution. The answer holds with "
        "95 % confidence. Techniques that store no map stand on a line of their own, and compete only for the lookup "
        "time.\n"
        "Exit codes: 0; 2 nothing reaches the error; 64 also if the budget ends before anything is measured; others as "
        "in shadowbench --help.");
    CLI::Option* scenario =
        recommend->add_option("SCENARIO", arguments->scenario, "A scenario file, or the name of one");
    check_error(
        recommend->add_option("--error", arguments->error, "The largest error that is good enough")->required());
    recommend
        ->add_option(
            "--measure", arguments->measure,
            "The error: of lookups against the truth (rms, max or p99), or the largest of the stored functions "
            "(curve)")
        ->check(CLI::IsMember({"rms", "max", "p99", "curve"}))
        ->capture_default_str();
    repeatable(
        recommend
            ->add_option("--cheapest", arguments->cheapest,
                         "The cost that counts: lookup, bytes, build (capturing the rays included), or all [all]")
            ->check(CLI::IsMember({"lookup", "bytes", "build", "all"})));
    repeatable(
        recommend->add_option("--at-most", arguments->at_most,
                              "cost=limit: settings that cost more are left out, as in bytes=4MiB, lookup=50ns or "
                              "build=2s"));
    recommend
        ->add_option("--budget", arguments->budget,
                     "Time for the truth, the exploration and the confirmation, as in 90s, 5min or 1h")
        ->capture_default_str();
    recommend->add_option("--light", arguments->light, "A light's name, or its number, from 0 [the only light]");
    add_job_options(*recommend, *arguments);
    add_only_option(*recommend, *arguments);
    add_folder_option(
        *recommend, arguments->out,
        "Folder of result.json, with every setting measured [results/recommendations/<scenario name>, in "
        "the current folder]. What an earlier call measured there for the same question, with this program "
        "on this machine, is not measured again");
    recommend
        ->add_option("--from", arguments->from,
                     "Answer from the result.json in this folder, which recommend or run wrote, without measuring")
        ->excludes(scenario)
        ->excludes("--only")
        ->excludes("--out");
    recommend
        ->add_option("--beside", arguments->beside,
                     "With --from: measure the cheapest settings of both again, in turns, beside those of the run or "
                     "exploration in this folder")
        ->needs("--from");
    commands.push_back({recommend, [arguments, recommend](std::ostream& out, std::ostream& err) {
                            arguments->measure_given = recommend->count("--measure") > 0;
                            refuse_without_measuring(*recommend, *arguments);
                            return recommend_command(*arguments, out, err) ? 0 : promise_broken;
                        }});
}

}  // namespace shadowbench::service
