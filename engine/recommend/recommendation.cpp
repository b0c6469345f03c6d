#include "recommend/recommendation.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "bench/clock.h"
#include "bench/disturbance.h"
#include "recommend/answer.h"
#include "recommend/record.h"
#include "recommend/trials.h"
#include "results/fields.h"
#include "results/report.h"

namespace shadowbench::recommend {

using base::Error;
using base::ErrorCode;

namespace {

// Without a measurement nothing is known of the error.
void refuse_too_short(const Exploration& found) {
    if (!found.measured.empty() || found.end != End::budget) return;
    throw Error(ErrorCode::usage, "--budget",
                fmt::format("{} ended before anything was measured: reading the scene and computing the truth took {}. "
                            "Give {} or more, or less truth (reference.samples_per_pixel, reference.queries)",
                            budget_text(found.goal.budget),
                            cost_text(1e3 * found.before, static_cast<std::size_t>(Cost::build)),
                            budget_text(longer_budget(found.before + found.goal.budget))));
}

}  // namespace

Explored explore(const nlohmann::json& document, const bench::RunOptions& options, const Request& request,
                 const Watch& watch, const std::filesystem::path& folder) {
    bench::RunOptions chosen = options;
    chosen.only = request.only;
    const bench::Stopwatch stopwatch;
    Trials trials(document, chosen, request.light, request.measure, watch.measuring);
    if (!folder.empty()) trials.keep_in(folder);
    Hooks hooks;
    hooks.seconds = [&] { return stopwatch.seconds(); };
    if (watch.exploring)
        hooks.progress = [&](const Progress& progress) { watch.exploring(progress, stopwatch.seconds()); };
    const std::optional<double> steal_before = bench::steal_seconds();
    Recommendation found{document.at("name").get<std::string>(), trials.light(), request.measure,
                         trials.footprint_share(), explore(trials, request.goal, hooks)};
    refuse_too_short(found.exploration);
    if (request.measure != Measure::curve) found.truth_error = trials.truth_error();
    if (const std::optional<double> after = bench::steal_seconds(); after && steal_before)
        found.exploration.steal = std::max(0.0, *after - *steal_before) / stopwatch.seconds();
    return {std::move(found), trials.result(), trials.taken(), trials.others()};
}

nlohmann::ordered_json to_json(const Explored& explored) {
    nlohmann::ordered_json out = results::to_json(explored.result);
    nlohmann::ordered_json& recommendation = out["recommendation"];
    recommendation["light"] = explored.recommendation.light;
    recommendation["measure"] = measure_words[static_cast<std::size_t>(explored.recommendation.measure)];
    const std::optional<double> share = explored.recommendation.footprint_share;
    recommendation["footprint_share"] = share ? nlohmann::ordered_json(*share) : nlohmann::ordered_json(nullptr);
    const std::optional<double> truth = explored.recommendation.truth_error;
    recommendation["truth_error"] = truth ? nlohmann::ordered_json(*truth) : nlohmann::ordered_json(nullptr);
    recommendation["measured_before"] = explored.taken;
    recommendation.update(to_json(explored.recommendation.exploration));
    recommendation["answer"] = answer_json(explored.recommendation, explored.recommendation.exploration.goal);
    return out;
}

bool is_recommendation(const nlohmann::json& document) {
    return document.is_object() && document.contains("recommendation");
}

Recommendation recommendation_from_json(const nlohmann::json& document, const std::string& origin) {
    if (!is_recommendation(document))
        throw Error(ErrorCode::bad_input, origin,
                    "holds no recommendation; name a folder that shadowbench recommend wrote");
    const results::Field whole = results::top(document, origin), from = whole.at("recommendation");
    const results::Field measure = from.at("measure");
    const auto word = std::find(std::begin(measure_words), std::end(measure_words), measure.text());
    if (word == std::end(measure_words)) results::refuse(measure.where, "there is no such measure of the error");
    std::optional<double> share;
    if (const results::Field given = from.at("footprint_share"); !given.is_null()) share = given.number();
    Recommendation read{whole.at("name").text(), from.at("light").text(),
                        static_cast<Measure>(word - std::begin(measure_words)), share,
                        exploration_from_json(from.value, from.where)};
    if (from.has("truth_error") && !from.at("truth_error").is_null())
        read.truth_error = from.at("truth_error").at_least_zero();
    return read;
}

nlohmann::ordered_json part_of_scenario(const Recommendation& recommendation, const Point& point) {
    nlohmann::ordered_json part = scenario_part(recommendation.exploration.families[point.family], point);
    if (part.contains("rays") && recommendation.footprint_share)
        part["receivers"] = {{"footprint", {{"share", *recommendation.footprint_share}}}};
    return part;
}

AnswerText answer_text(const Recommendation& recommendation, const Goal& goal, std::size_t width,
                       const std::function<std::string(double)>& again) {
    const std::vector<Family>& families = recommendation.exploration.families;
    const Answer answer = recommend::answer(recommendation.exploration, goal);
    const auto paste = [&](const Point& point) { return part_of_scenario(recommendation, point).dump(); };
    return {fmt::format("{}, light {}\n", recommendation.scenario, recommendation.light) +
                to_text(answer, families,
                        {measure_words[static_cast<std::size_t>(recommendation.measure)], paste, width,
                         recommendation.truth_error, again}),
            answer.reached};
}

}  // namespace shadowbench::recommend
