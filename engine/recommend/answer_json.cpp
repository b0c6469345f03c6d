#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "recommend/recommendation.h"

namespace shadowbench::recommend {
namespace {

using nlohmann::ordered_json;

constexpr const char* cost_members[costs] = {"lookup_ns", "bytes", "build_ms"};

ordered_json finite_or_null(double value) {
    return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json choice_json(const Recommendation& recommendation, const Choice& choice) {
    const std::vector<Family>& families = recommendation.exploration.families;
    ordered_json out{{"technique", families[choice.point.family].technique},
                     {"setting", setting_text(families, choice.point)},
                     {"confirmed", choice.confirmed},
                     {"error", {finite_or_null(choice.error.low), finite_or_null(choice.error.high)}}};
    for (std::size_t k = 0; k < costs; ++k) out[cost_members[k]] = finite_or_null(choice.cost[k]);
    out["part"] = part_of_scenario(recommendation, choice.point);
    return out;
}

ordered_json choice_or_null(const Recommendation& recommendation, const std::optional<Choice>& choice) {
    return choice ? choice_json(recommendation, *choice) : ordered_json(nullptr);
}

ordered_json cheapest_json(const Recommendation& recommendation, const Cheapest& cheapest, std::size_t k) {
    ordered_json out{{"cost", cost_members[k]}};
    out.update(choice_json(recommendation, cheapest.best));
    out["runner_up"] = choice_or_null(recommendation, cheapest.runner_up);
    if (cheapest.runner_up) {
        out["runner_up"]["behind"] = finite_or_null(cheapest.behind);
        out["runner_up"]["tie"] = cheapest.tie;
    }
    out["perhaps"] = choice_or_null(recommendation, cheapest.perhaps);
    return out;
}

}  // namespace

ordered_json answer_json(const Recommendation& recommendation, const Goal& goal) {
    const Answer found = answer(recommendation.exploration, goal);
    ordered_json cheapest = ordered_json::array(), missed = ordered_json::array(), broken = ordered_json::array();
    for (std::size_t k = 0; k < costs; ++k)
        if (found.cheapest[k]) cheapest.push_back(cheapest_json(recommendation, *found.cheapest[k], k));
    for (const Missed& one : found.missed)
        missed.push_back({{"technique", one.technique},
                          {"why", to_string(one.held)},
                          {"error", one.closest ? finite_or_null(one.closest->error.high) : ordered_json(nullptr)}});
    for (const Broken& one : found.broken)
        broken.push_back({{"technique", one.technique},
                          {"settings", one.settings},
                          {"measured", one.measured},
                          {"reason", one.reason}});
    ordered_json too_early = nullptr;
    if (found.too_early())
        too_early = {{"budget_seconds", finite_or_null(found.budget)},
                     {"techniques", found.techniques},
                     {"open", found.open},
                     {"give_seconds", longer_budget(found.budget)}};
    return {{"reached", found.reached},
            {"too_early", std::move(too_early)},
            {"cheapest", std::move(cheapest)},
            {"without_map", choice_or_null(recommendation, found.without_map)},
            {"closest", choice_or_null(recommendation, found.closest)},
            {"missed", std::move(missed)},
            {"broken", std::move(broken)},
            {"cut", found.cut}};
}

}  // namespace shadowbench::recommend
