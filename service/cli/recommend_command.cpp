#include "service/cli/recommend_command.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/read_text.h"
#include "base/shell_word.h"
#include "base/table.h"
#include "base/write_files.h"
#include "recommend/beside.h"
#include "recommend/of_run.h"
#include "recommend/recommendation.h"
#include "results/merge_cells.h"
#include "results/report.h"
#include "scene/scenario.h"
#include "service/cli/job.h"
#include "service/cli/progress_bar.h"
#include "service/cli/quantity.h"
#include "service/cli/swept_scenarios.h"
#include "service/cli/terminal.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;
using recommend::Cost;
using recommend::cost_words;
using recommend::measure_words;
using recommend::Recommendation;

std::span<const Unit> units_of(std::size_t cost) {
    if (cost == static_cast<std::size_t>(Cost::lookup)) return nanosecond_units;
    return cost == static_cast<std::size_t>(Cost::bytes) ? std::span<const Unit>(byte_units) : millisecond_units;
}

recommend::Goal read_goal(const RecommendArguments& arguments) {
    recommend::Goal goal;
    goal.error = arguments.error;
    goal.budget = read_quantity(arguments.budget, second_units, "--budget");
    const std::vector<std::string>& asked = arguments.cheapest;
    const bool all = asked.empty() || std::count(asked.begin(), asked.end(), "all") > 0;
    for (std::size_t k = 0; k < recommend::costs; ++k)
        goal.asked[k] = all || std::count(asked.begin(), asked.end(), cost_words[k]) > 0;
    for (const std::string& text : arguments.at_most) {
        const std::string name = text.substr(0, text.find('='));
        const auto cost = std::find(std::begin(cost_words), std::end(cost_words), name);
        if (name.size() == text.size() || cost == std::end(cost_words))
            throw Error(ErrorCode::usage, "--at-most " + text, "give lookup=, bytes= or build= with a limit");
        const std::size_t k = static_cast<std::size_t>(cost - std::begin(cost_words));
        goal.at_most[k] = read_quantity(text.substr(name.size() + 1), units_of(k), "--at-most " + name);
    }
    return goal;
}

recommend::Measure read_measure(const std::string& word) {
    const auto found = std::find(std::begin(measure_words), std::end(measure_words), word);
    return static_cast<recommend::Measure>(found - std::begin(measure_words));
}

// Times of different machines do not rank settings.
void refuse_times_of_machines(const nlohmann::json& result, const recommend::Goal& goal, const std::string& file) {
    const std::size_t machines = results::machines_of(result).size();
    if (machines < 2) return;
    for (const Cost cost : {Cost::lookup, Cost::build}) {
        const std::size_t k = static_cast<std::size_t>(cost);
        if (goal.asked[k] || std::isfinite(goal.at_most[k]))
            throw Error(ErrorCode::bad_input, file,
                        fmt::format("its cells were measured on {} machines, and times of different machines cannot be "
                                    "ranked; ask for --cheapest bytes, without limits of times",
                                    machines));
    }
}

// An exploration is of one light and one measure: nothing else can be asked of it.
void refuse_other_questions(const Recommendation& found, const RecommendArguments& arguments) {
    const char* measure = measure_words[static_cast<std::size_t>(found.measure)];
    if (arguments.measure_given && arguments.measure != measure)
        throw Error(
            ErrorCode::usage, "--measure " + arguments.measure,
            fmt::format("the exploration in --from was judged by {}; explore again for another measure", measure));
    if (!arguments.light.empty() && arguments.light != found.light)
        throw Error(ErrorCode::usage, "--light " + arguments.light,
                    fmt::format("the exploration in --from is of light \"{}\"", found.light));
}

// Of an exploration, which says its light and measure, or of a run. `asked`: these must be those, if they are given.
Recommendation read_recommendation(const fs::path& folder, const std::string& light, recommend::Measure measure,
                                   const recommend::Goal& goal, const RecommendArguments* asked = nullptr) {
    const std::string file = (folder / "result.json").string();
    const nlohmann::json document = scene::parse_json(base::read_text(file), file);
    if (recommend::is_recommendation(document)) {
        Recommendation found = recommend::recommendation_from_json(document, file);
        if (asked) refuse_other_questions(found, *asked);
        return found;
    }
    refuse_times_of_machines(document, goal, file);
    return recommend::recommendation_of(results::from_json(document, file), light, measure, file);
}

const char* stage_name(recommend::Stage stage) {
    return stage == recommend::Stage::climbing ? "climb" : stage == recommend::Stage::refining ? "refine" : "confirm";
}

// Where an exploration keeps its trials, so that it goes on after a kill.
fs::path trials_folder(const fs::path& folder) {
    return folder / "trials";
}

// Explores the scenario and writes the result.
recommend::Explored explore_scenario(const RecommendArguments& arguments, const recommend::Goal& goal, fs::path& folder,
                                     std::ostream& err) {
    const Job job = read_job(arguments);
    folder = output_folder(arguments.out, "results/recommendations", *job.document);
    base::Undo made;
    base::make_writable(folder, made);
    made.record(trials_folder(folder));  // stays unless it is empty
    ProgressBar bar(err);
    recommend::Watch watch;
    watch.measuring = [&](const bench::Progress& progress) { bar.show(progress); };
    watch.exploring = [&](const recommend::Progress& progress, double seconds) {
        bar.show({fmt::format("{} measured, {} open,", progress.measured, progress.open), stage_name(progress.stage),
                  static_cast<std::size_t>(std::min(seconds, goal.budget)), static_cast<std::size_t>(goal.budget)});
    };
    recommend::Explored explored = recommend::explore(
        *job.document, job.options, {goal, read_measure(arguments.measure), arguments.light, arguments.only}, watch,
        trials_folder(folder));
    bar.end();
    base::write_files({{folder / "result.json", recommend::to_json(explored).dump(1) + "\n"},
                       {folder / "result.csv", results::to_csv(explored.result)}});
    made.keep();
    return explored;
}

// What trials of earlier explorations gave; empty if there are none.
std::string trials_text(const recommend::Explored& explored, const fs::path& folder) {
    std::string text;
    if (explored.taken > 0)
        text += fmt::format("{} of {} settings were measured before: {} has them. What is confirmed is measured now.\n",
                            explored.taken, explored.recommendation.exploration.measured.size(),
                            trials_folder(folder).string());
    if (explored.others > 0)
        text += fmt::format("{} files of {} do not count: they are of another question, program or machine\n",
                            explored.others, trials_folder(folder).string());
    return text;
}

// Measures the cheapest settings of two answers again.
std::string beside(const RecommendArguments& arguments, const recommend::Goal& goal, const Recommendation& ours,
                   std::ostream& err) {
    const Job job = read_job(arguments, fs::path(arguments.from) / "result.json"),
              other = read_job(arguments, fs::path(arguments.beside) / "result.json");
    ProgressBar bar(err);
    const std::vector<recommend::Contest> contests =
        recommend::hold_beside(*job.document, job.options, ours, *other.document,
                               read_recommendation(arguments.beside, ours.light, ours.measure, goal), goal, goal.budget,
                               [&](const bench::Progress& progress) { bar.show(progress); });
    bar.end();
    return recommend::to_text(contests, measure_words[static_cast<std::size_t>(ours.measure)], goal.error);
}

// The command for the same question with a budget of so many seconds.
std::string command_again(const RecommendArguments& arguments, double budget) {
    std::string command = fmt::format("shadowbench recommend {} --error {}", base::shell_word(arguments.scenario),
                                      base::number_text(arguments.error));
    const auto add = [&](const char* option, const std::string& value) {
        if (!value.empty()) command += fmt::format(" {} {}", option, base::shell_word(value));
    };
    const auto add_all = [&](const char* option, const std::vector<std::string>& values) {
        for (const std::string& value : values) add(option, value);
    };
    if (arguments.measure_given) add("--measure", arguments.measure);
    add_all("--cheapest", arguments.cheapest);
    add_all("--at-most", arguments.at_most);
    add("--light", arguments.light);
    for (const std::string& word : arguments_again(arguments)) command += " " + base::shell_word(word);
    add("--out", arguments.out);
    add("--budget", recommend::budget_text(budget));
    return command;
}

}  // namespace

bool recommend_command(const RecommendArguments& arguments, std::ostream& out, std::ostream& err) {
    const recommend::Goal goal = read_goal(arguments);
    if (arguments.from.empty() && arguments.scenario.empty())
        throw Error(ErrorCode::usage, "SCENARIO",
                    "name a scenario, or the folder of a finished recommend or run with --from");
    fs::path folder = arguments.from;
    std::string more;  // about what was written
    const auto explored = [&] {
        recommend::Explored all = explore_scenario(arguments, goal, folder, err);
        more = trials_text(all, folder) + fmt::format("written: {0}/result.json, {0}/result.csv\n", folder.string());
        return std::move(all.recommendation);
    };
    const std::function<std::string(double)> again = [&](double budget) { return command_again(arguments, budget); };
    const Recommendation found =
        arguments.from.empty()
            ? explored()
            : read_recommendation(arguments.from, arguments.light, read_measure(arguments.measure), goal, &arguments);
    const recommend::AnswerText answer = recommend::answer_text(
        found, goal, line_width(out), arguments.from.empty() ? again : std::function<std::string(double)>());
    out << answer.text << more;
    if (!arguments.beside.empty()) out << base::wrapped(beside(arguments, goal, found, err), line_width(out));
    return answer.reached;
}

}  // namespace shadowbench::service
