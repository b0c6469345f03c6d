#include "service/cli/recommend_command.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/read_text.h"
#include "base/write_files.h"
#include "recommend/answer.h"
#include "recommend/record.h"
#include "recommend/search.h"
#include "recommend/trials.h"
#include "results/fields.h"
#include "results/report.h"
#include "scene/scenario.h"
#include "service/cli/job.h"
#include "service/cli/progress_bar.h"
#include "service/cli/quantity.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;
using recommend::Cost;
using recommend::Exploration;
using recommend::Goal;
using recommend::Measure;

constexpr const char* cost_words[recommend::costs] = {"lookup", "bytes", "build"};
constexpr const char* measure_words[] = {"rms", "max", "p99", "curve"};

std::span<const Unit> units_of(std::size_t cost) {
    if (cost == static_cast<std::size_t>(Cost::lookup)) return nanosecond_units;
    return cost == static_cast<std::size_t>(Cost::bytes) ? std::span<const Unit>(byte_units) : millisecond_units;
}

Goal read_goal(const RecommendArguments& arguments) {
    Goal goal;
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

Measure read_measure(const std::string& word) {
    const auto found = std::find(std::begin(measure_words), std::end(measure_words), word);
    return static_cast<Measure>(found - std::begin(measure_words));
}

// What was explored, and of what.
struct Explored {
    std::string scenario, light;
    Measure measure = Measure::rms;
    std::optional<double> footprint_share;  // see Trials
    Exploration exploration;
};

Explored read_explored(const fs::path& folder) {
    const fs::path file = folder / "result.json";
    const nlohmann::json document = scene::parse_json(base::read_text(file), file.string());
    if (!document.is_object() || !document.contains("recommendation"))
        throw Error(ErrorCode::bad_input, file.string(),
                    "holds no recommendation; name a folder that shadowbench recommend wrote");
    const results::Field whole = results::top(document, file.string()), from = whole.at("recommendation");
    Explored explored{whole.at("name").text(), from.at("light").text(), {}, {}, {}};
    explored.measure = read_measure(from.at("measure").text());
    if (const results::Field share = from.at("footprint_share"); !share.is_null())
        explored.footprint_share = share.number();
    explored.exploration = recommend::exploration_from_json(from.value, from.where);
    return explored;
}

nlohmann::ordered_json to_json(const Explored& explored, const results::Result& result) {
    nlohmann::ordered_json out = results::to_json(result);
    nlohmann::ordered_json& recommendation = out["recommendation"];
    recommendation["light"] = explored.light;
    recommendation["measure"] = measure_words[static_cast<std::size_t>(explored.measure)];
    recommendation["footprint_share"] =
        explored.footprint_share ? nlohmann::ordered_json(*explored.footprint_share) : nlohmann::ordered_json(nullptr);
    recommendation.update(recommend::to_json(explored.exploration));
    return out;
}

// The part of the scenario that gives this setting, and asks it the same question.
std::string paste_line(const Explored& explored, const recommend::Point& point) {
    const recommend::Family& family = explored.exploration.families[point.family];
    nlohmann::ordered_json part = recommend::scenario_part(family, point);
    if (part.contains("rays") && explored.footprint_share)
        part["receivers"] = {{"footprint", {{"share", *explored.footprint_share}}}};
    return part.dump();
}

const char* stage_name(recommend::Stage stage) {
    return stage == recommend::Stage::climbing ? "climb" : stage == recommend::Stage::refining ? "refine" : "confirm";
}

// Explores the scenario and writes the result.
Explored explore_scenario(const RecommendArguments& arguments, const Goal& goal, fs::path& folder, std::ostream& err) {
    const Job job = read_job(arguments);
    folder = output_folder(arguments.out, "results/recommendations", *job.document);
    base::Undo made;
    base::make_writable(folder, made);
    ProgressBar bar(err);
    const auto show = [&](const bench::Progress& progress) { bar.show(progress); };
    const Measure measure = read_measure(arguments.measure);
    using Clock = std::chrono::steady_clock;
    const Clock::time_point began = Clock::now();
    recommend::Trials trials(*job.document, job.options, arguments.light, measure, show);

    recommend::Hooks hooks;
    hooks.seconds = [&] { return std::chrono::duration<double>(Clock::now() - began).count(); };
    hooks.progress = [&](const recommend::Progress& progress) {
        bar.show({fmt::format("{} measured, {} open,", progress.measured, progress.open), stage_name(progress.stage),
                  static_cast<std::size_t>(std::min(hooks.seconds(), goal.budget)),
                  static_cast<std::size_t>(goal.budget)});
    };
    Explored explored{job.document->at("name").get<std::string>(), trials.light(), measure,
                      trials.footprint_share(), recommend::explore(trials, goal, hooks)};
    const results::Result result = trials.result();
    bar.end();
    base::write_files({{folder / "result.json", to_json(explored, result).dump(1) + "\n"},
                       {folder / "result.csv", results::to_csv(result)}});
    made.keep();
    return explored;
}

}  // namespace

bool recommend_command(const RecommendArguments& arguments, std::ostream& out, std::ostream& err) {
    const Goal goal = read_goal(arguments);
    if (arguments.from.empty() && arguments.scenario.empty())
        throw Error(ErrorCode::usage, "SCENARIO", "name a scenario, or the folder of an exploration with --from");
    fs::path folder = arguments.from;
    const Explored explored =
        arguments.from.empty() ? explore_scenario(arguments, goal, folder, err) : read_explored(arguments.from);
    const std::vector<recommend::Family>& families = explored.exploration.families;
    const recommend::Answer answer = recommend::answer(explored.exploration, goal);
    const auto paste = [&](const recommend::Point& point) {
        return paste_line(explored, point);
    };
    out << fmt::format("{}, light {}\n", explored.scenario, explored.light)
        << recommend::to_text(answer, families, {measure_words[static_cast<std::size_t>(explored.measure)], paste});
    if (arguments.from.empty()) out << fmt::format("written: {0}/result.json, {0}/result.csv\n", folder.string());
    return answer.reached;
}

}  // namespace shadowbench::service
