#include "recommend/beside.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "recommend/answer.h"
#include "recommend/record.h"
#include "recommend/trials.h"

namespace shadowbench::recommend {
namespace {

using base::Error;
using base::ErrorCode;
using nlohmann::json;

constexpr double most_for_lookups = 0.6;  // of the time: what is compared there is the closest

// The receivers without the width of their footprints, and that width as a share of the map.
json places_of(const json& document) {
    json receivers = document.value("receivers", json::object());
    receivers.erase("footprint");
    receivers.erase("filter_width");
    return receivers;
}

void check_same_question(const json& ours, const Recommendation& our, const json& theirs, const Recommendation& their) {
    const auto differ = [](const char* what) {
        throw Error(ErrorCode::bad_input, what, "differs between the two scenarios, so they ask different questions");
    };
    for (const char* key : {"scene", "lights"})
        if (ours.value(key, json()) != theirs.value(key, json())) differ(fmt::format("/{}", key).c_str());
    if (our.light != their.light) differ("the light");
    if (our.measure != their.measure) differ("the measure of the error");
    const json places = places_of(ours);
    if (places != places_of(theirs)) differ("/receivers");
    const auto resolution = [](const json& document) {
        return document.value("rays", json::object()).value("resolution", json());
    };
    // These biases are in pixels of the scenario's own map.
    const bool in_pixels = places.contains("slope_bias") || places.contains("normal_bias");
    if (in_pixels && resolution(ours) != resolution(theirs)) differ("/rays/resolution");
    const auto footprint = [](const json& document, const Recommendation& of) {
        return of.footprint_share ? json{{"share", *of.footprint_share}}
                                  : document.value("receivers", json::object()).value("footprint", json());
    };
    if (footprint(ours, our) != footprint(theirs, their)) differ("/receivers/footprint");
}

std::optional<Rival> rival(const Recommendation& of, const std::optional<Cheapest>& cheapest) {
    if (!cheapest) return {};
    const Point& point = cheapest->best.point;
    const std::vector<Family>& families = of.exploration.families;
    nlohmann::ordered_json part = scenario_part(families[point.family], point);
    // The two scenarios may have other rays, so the part states its rays.
    for (std::size_t a = 0; a < 2; ++a) {
        const Axis& axis = families[point.family].axes[a];
        part["rays"][axis.name] = json::parse(axis.values[static_cast<std::size_t>(point.step[a])]);
    }
    return Rival{setting_text(families, point), part.dump()};
}

metrics::Interval ratio_of(const Confirmed& ours, const Confirmed& theirs, std::size_t k) {
    if (static_cast<Cost>(k) == Cost::lookup) {
        std::vector<double> ratios;
        for (std::size_t r = 0; r < ours.lookup_rounds.size(); ++r)
            ratios.push_back(ours.lookup_rounds[r] / theirs.lookup_rounds[r]);
        return metrics::median_interval(ratios);
    }
    return {ours.interval[k].low / theirs.interval[k].high, ours.interval[k].high / theirs.interval[k].low};
}

const char* verdict(const Contest& contest) {
    const metrics::Interval& ratio = *contest.ratio;
    if (contest.ours->part == contest.theirs->part) return "the same setting";
    return ratio.high < 1.0 ? "cheaper" : ratio.low > 1.0 ? "dearer" : "not told apart";
}

std::string side_text(const char* whose, const Rival& rival, std::size_t k, double error) {
    const Confirmed& measured = rival.measured;
    if (!measured.failed.empty()) return fmt::format("       {} {}: failed: {}\n", whose, rival.text, measured.failed);
    const bool exact = measured.interval[k].low == measured.interval[k].high;
    return fmt::format("       {} {}{}, error {:.3g} to {:.3g}{}\n         {}\n", whose, cost_text(measured.cost[k], k),
                       exact ? "" : fmt::format(" ({:.3g} to {:.3g})", measured.interval[k].low, measured.interval[k].high),
                       measured.error.low, measured.error.high,
                       measured.error.high > error ? ", above the error asked when measured again" : "", rival.text);
}

}  // namespace

std::vector<Contest> hold_beside(const json& document, const bench::RunOptions& options, const Recommendation& ours,
                                 const json& their_document, const Recommendation& theirs, const Goal& goal,
                                 double seconds, const bench::ProgressCallback& progress) {
    check_same_question(document, ours, their_document, theirs);
    const Answer ours_best = answer(ours.exploration, goal), theirs_best = answer(theirs.exploration, goal);
    std::vector<Contest> contests;
    for (std::size_t k = 0; k < costs; ++k) {
        if (!ours_best.cheapest[k] && !theirs_best.cheapest[k]) continue;
        contests.push_back({static_cast<Cost>(k), rival(ours, ours_best.cheapest[k]),
                            rival(theirs, theirs_best.cheapest[k]), {}});
    }
    if (contests.empty()) return contests;

    Trials trials(document, options, ours.light, ours.measure, progress);
    std::vector<std::string> parts;
    std::vector<Point> points;
    for (const Contest& contest : contests)
        for (const std::optional<Rival>* one : {&contest.ours, &contest.theirs})
            if (*one && std::find(parts.begin(), parts.end(), (*one)->part) == parts.end()) {
                parts.push_back((*one)->part);
                points.push_back(trials.add(json::parse(parts.back())));
            }
    const std::vector<Confirmed> measured = trials.confirm(
        points, {goal.error, goal.asked[static_cast<std::size_t>(Cost::build)], seconds, most_for_lookups});
    for (Contest& contest : contests) {
        for (std::optional<Rival>* one : {&contest.ours, &contest.theirs})
            if (*one)
                (*one)->measured =
                    measured[static_cast<std::size_t>(std::find(parts.begin(), parts.end(), (*one)->part) - parts.begin())];
        if (contest.ours && contest.theirs && contest.ours->measured.failed.empty() &&
            contest.theirs->measured.failed.empty())
            contest.ratio = ratio_of(contest.ours->measured, contest.theirs->measured, static_cast<std::size_t>(contest.cost));
    }
    return contests;
}

std::string to_text(const std::vector<Contest>& contests, const std::string& measure, double error) {
    std::string text = fmt::format("beside each other, measured again in turns: {} error at most {:.4g}\n", measure, error);
    if (contests.empty()) return text + "neither reaches it\n";
    for (const Contest& contest : contests) {
        const std::size_t k = static_cast<std::size_t>(contest.cost);
        text += fmt::format("{:<6} ", cost_words[k]);
        if (contest.ratio)
            text += fmt::format("{}: ours over theirs {:.3f} to {:.3f}\n", verdict(contest), contest.ratio->low,
                                contest.ratio->high);
        else
            text += !contest.theirs ? "only ours reaches it\n" : !contest.ours ? "only theirs reaches it\n" : "no ratio\n";
        if (contest.ours) text += side_text("ours", *contest.ours, k, error);
        if (contest.theirs) text += side_text("theirs", *contest.theirs, k, error);
    }
    return text;
}

}  // namespace shadowbench::recommend
