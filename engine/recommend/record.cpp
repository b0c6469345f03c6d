#include "recommend/record.h"

#include <cmath>
#include <iterator>
#include <utility>

#include <nlohmann/json.hpp>

#include "results/fields.h"

namespace shadowbench::recommend {
namespace {

using json = nlohmann::ordered_json;
using results::Field;

constexpr const char* cost_names[costs] = {"lookup_ns", "bytes", "build_ms"};
constexpr const char* ends[] = {"complete", "budget", "cancelled", "given"};

json number(double value) {
    return std::isfinite(value) ? json(value) : json(nullptr);
}

json to_json(const metrics::Interval& interval) {
    return {number(interval.low), number(interval.high)};
}

json to_json(const Goal& goal) {
    json cheapest = json::array(), at_most = json::object();
    for (std::size_t k = 0; k < costs; ++k) {
        if (goal.asked[k]) cheapest.push_back(cost_names[k]);
        if (std::isfinite(goal.at_most[k])) at_most[cost_names[k]] = goal.at_most[k];
    }
    return {
        {"error", goal.error}, {"cheapest", cheapest}, {"at_most", at_most}, {"budget_seconds", number(goal.budget)}};
}

json to_json(const Family& family) {
    json words = json::object(), axes = json::array();
    for (const Family::Word& word : family.words) words[word.name] = json::parse(word.value);
    for (const Axis& axis : family.axes)
        axes.push_back({{"name", axis.name}, {"values", axis.values}, {"stride", axis.stride}});
    return {{"technique", family.technique},
            {"name", family.name},
            {"words", words},
            {"axes", axes},
            {"mapless", family.mapless}};
}

json to_json(const Measured& measured) {
    json out = {{"family", measured.point.family}, {"step", measured.point.step}, {"failed", measured.trial.failed}};
    out["error"] = number(measured.trial.error);
    for (std::size_t k = 0; k < costs; ++k) out[cost_names[k]] = number(measured.trial.cost[k]);
    return out;
}

json to_json(const Answered& answered) {
    const Confirmed& confirmed = answered.confirmed;
    json out = {{"family", answered.point.family}, {"step", answered.point.step}, {"failed", confirmed.failed}};
    out["cut"] = confirmed.cut;
    out["error"] = {{"mean", number(confirmed.mean_error)}, {"interval95", to_json(confirmed.error)}};
    for (std::size_t k = 0; k < costs; ++k)
        out[cost_names[k]] = {{"median", number(confirmed.cost[k])}, {"interval95", to_json(confirmed.interval[k])}};
    return out;
}

// Reading.

metrics::Interval read_interval(const Field& field) {
    if (field.array().size() != 2) results::refuse(field.where, "must hold two numbers");
    return {field.item(0).number_or_infinity(), field.item(1).number_or_infinity()};
}

Goal read_goal(const Field& field) {
    Goal goal;
    goal.error = field.at("error").number();
    goal.asked = {};
    const Field cheapest = field.at("cheapest"), at_most = field.at("at_most");
    for (std::size_t k = 0; k < costs; ++k) {
        for (std::size_t i = 0; i < cheapest.array().size(); ++i)
            goal.asked[k] = goal.asked[k] || cheapest.item(i).text() == cost_names[k];
        if (at_most.has(cost_names[k])) goal.at_most[k] = at_most.at(cost_names[k]).number();
    }
    goal.budget = field.at("budget_seconds").number_or_infinity();
    return goal;
}

Family read_family(const Field& field) {
    Family family{field.at("technique").text(), field.at("name").text(), {}, {}};
    for (const auto& [name, value] : field.at("words").object().items()) family.words.push_back({name, value.dump()});
    family.mapless = field.at("mapless").truth();
    const Field axes = field.at("axes");
    for (std::size_t a = 0; a < axes.array().size(); ++a) {
        const Field from = axes.item(a), values = from.at("values");
        Axis axis{from.at("name").text(), {}, static_cast<int>(from.at("stride").count())};
        for (std::size_t i = 0; i < values.array().size(); ++i) axis.values.push_back(values.item(i).text());
        if (axis.values.empty() || axis.stride < 1)
            results::refuse(from.where, "must have values and a stride above 0");
        family.axes.push_back(std::move(axis));
    }
    if (family.axes.size() < 2) results::refuse(axes.where, "must hold at least the resolution and the samples");
    return family;
}

Point read_point(const Field& field, const std::vector<Family>& families) {
    Point point{field.at("family").count(), {}};
    if (point.family >= families.size()) results::refuse(field.at("family").where, "there is no such family");
    const std::vector<Axis>& axes = families[point.family].axes;
    const Field step = field.at("step");
    if (step.array().size() != axes.size()) results::refuse(step.where, "must hold one number for each axis");
    for (std::size_t a = 0; a < axes.size(); ++a) {
        const std::uint64_t value = step.item(a).count();
        if (value >= axes[a].values.size()) results::refuse(step.item(a).where, "the axis has no such step");
        point.step.push_back(static_cast<int>(value));
    }
    return point;
}

Measured read_measured(const Field& field, const std::vector<Family>& families) {
    Measured measured{read_point(field, families), {}};
    measured.trial.failed = field.at("failed").text();
    measured.trial.error = field.at("error").number_or_infinity();
    for (std::size_t k = 0; k < costs; ++k) measured.trial.cost[k] = field.at(cost_names[k]).number_or_infinity();
    return measured;
}

Answered read_answered(const Field& field, const std::vector<Family>& families) {
    Answered answered{read_point(field, families), {}};
    Confirmed& confirmed = answered.confirmed;
    confirmed.failed = field.at("failed").text();
    confirmed.cut = field.at("cut").truth();
    confirmed.mean_error = field.at("error").at("mean").number_or_infinity();
    confirmed.error = read_interval(field.at("error").at("interval95"));
    for (std::size_t k = 0; k < costs; ++k) {
        confirmed.cost[k] = field.at(cost_names[k]).at("median").number_or_infinity();
        confirmed.interval[k] = read_interval(field.at(cost_names[k]).at("interval95"));
    }
    return answered;
}

}  // namespace

json to_json(const Exploration& exploration) {
    json families = json::array(), measured = json::array(), confirmed = json::array();
    for (const Family& family : exploration.families) families.push_back(to_json(family));
    for (const Measured& one : exploration.measured) measured.push_back(to_json(one));
    for (const Answered& one : exploration.confirmed) confirmed.push_back(to_json(one));
    return {{"goal", to_json(exploration.goal)},
            {"end", ends[static_cast<std::size_t>(exploration.end)]},
            {"before_seconds", exploration.before},
            {"next", exploration.next ? json{{"seconds", exploration.next->seconds}, {"left", exploration.next->left}}
                                      : json(nullptr)},
            {"steal", exploration.steal ? json(*exploration.steal) : json(nullptr)},
            {"scout", exploration.scout ? json(*exploration.scout) : json(nullptr)},
            {"families", std::move(families)},
            {"measured", std::move(measured)},
            {"confirmed", std::move(confirmed)}};
}

Exploration exploration_from_json(const nlohmann::json& recommendation, const std::string& where) {
    const Field whole = results::top(recommendation, where);
    Exploration exploration;
    exploration.goal = read_goal(whole.at("goal"));
    for (std::size_t i = 0; i < std::size(ends); ++i)
        if (whole.at("end").text() == ends[i]) exploration.end = static_cast<End>(i);
    if (whole.has("steal") && !whole.at("steal").is_null()) exploration.steal = whole.at("steal").at_least_zero();
    if (whole.has("before_seconds")) exploration.before = whole.at("before_seconds").at_least_zero();
    if (whole.has("next") && !whole.at("next").is_null())
        exploration.next = {whole.at("next").at("seconds").at_least_zero(),
                            whole.at("next").at("left").at_least_zero()};
    const Field families = whole.at("families"), measured = whole.at("measured"), confirmed = whole.at("confirmed");
    for (std::size_t i = 0; i < families.array().size(); ++i)
        exploration.families.push_back(read_family(families.item(i)));
    if (const Field scout = whole.at("scout"); !scout.is_null()) {
        exploration.scout = scout.count();
        if (*exploration.scout >= exploration.families.size()) results::refuse(scout.where, "there is no such family");
    }
    for (std::size_t i = 0; i < measured.array().size(); ++i)
        exploration.measured.push_back(read_measured(measured.item(i), exploration.families));
    for (std::size_t i = 0; i < confirmed.array().size(); ++i)
        exploration.confirmed.push_back(read_answered(confirmed.item(i), exploration.families));
    return exploration;
}

json scenario_part(const Family& family, const Point& point) {
    json rays = json::object(), technique = {{"type", family.technique}};
    for (std::size_t a = 0; a < family.axes.size(); ++a) {
        const Axis& axis = family.axes[a];
        if (a >= 2)
            technique[axis.name] = json::parse(axis.values[static_cast<std::size_t>(point.step[a])]);
        else if (axis.steps() > 1)
            rays[axis.name] = json::parse(axis.values[static_cast<std::size_t>(point.step[a])]);
    }
    for (const Family::Word& word : family.words) technique[word.name] = json::parse(word.value);
    json out = json::object();
    if (!rays.empty()) out["rays"] = std::move(rays);
    out["techniques"] = json::array({std::move(technique)});
    return out;
}

}  // namespace shadowbench::recommend
