#include "recommend/answer.h"

#include <algorithm>
#include <limits>

#include "metrics/pareto.h"
#include "recommend/incumbents.h"
#include "recommend/knowledge.h"
#include "recommend/ladder.h"

namespace shadowbench::recommend {
namespace {

// All settings that did not fail, and which of the measured ones that are confirmed.
std::vector<Choice> choices(const Exploration& found) {
    const double grown = growth(found);
    std::vector<Choice> result;
    for (const Measured& measured : found.measured) {
        const auto answered = std::find_if(found.confirmed.begin(), found.confirmed.end(),
                                           [&](const Answered& a) { return a.point == measured.point; });
        Choice choice{measured.point, answered != found.confirmed.end(), {0.0, 0.0}, {}, {}};
        if (!measured.trial.failed.empty() || (choice.confirmed && !answered->confirmed.failed.empty())) continue;
        if (choice.confirmed) {
            choice.error = answered->confirmed.error;
            choice.cost = answered->confirmed.cost;
            choice.interval = answered->confirmed.interval;
        } else {
            choice.error = {measured.trial.error, measured.trial.error * grown};
            choice.cost = measured.trial.cost;
            for (std::size_t k = 0; k < costs; ++k)
                choice.interval[k] = {choice.cost[k] / cost_noise[k], choice.cost[k] * cost_noise[k]};
        }
        result.push_back(choice);
    }
    return result;
}

bool within(const Choice& choice, const Goal& goal) {
    for (std::size_t k = 0; k < costs; ++k)
        if ((choice.confirmed ? choice.interval[k].high : choice.cost[k]) > goal.at_most[k]) return false;
    return true;
}

bool good_enough(const Choice& choice, const Goal& goal) {
    return choice.error.high <= goal.error && within(choice, goal);
}

const std::string& technique_of(const Exploration& found, const Choice& choice) {
    return found.families[choice.point.family].technique;
}

// The cheapest: a confirmed one if there is any.
const Choice* cheapest_of(const std::vector<const Choice*>& candidates, std::size_t k) {
    const Choice* best = nullptr;
    for (const Choice* choice : candidates)
        if (!best || (choice->confirmed != best->confirmed ? choice->confirmed : choice->cost[k] < best->cost[k]))
            best = choice;
    return best;
}

std::optional<Cheapest> cheapest(const Exploration& found, const std::vector<const Choice*>& candidates,
                                 std::size_t k) {
    const Choice* best = cheapest_of(candidates, k);
    if (!best) return {};
    Cheapest result{*best, {}, 0.0, false, {}};
    std::vector<const Choice*> others, unsure;
    for (const Choice* choice : candidates) {
        if (technique_of(found, *choice) != technique_of(found, *best)) others.push_back(choice);
        if (best->confirmed && !choice->confirmed && choice->interval[k].high < best->interval[k].low)
            unsure.push_back(choice);
    }
    if (const Choice* second = cheapest_of(others, k)) {
        result.runner_up = *second;
        result.behind = second->cost[k] / best->cost[k] - 1.0;
        result.tie =
            second->interval[k].low <= best->interval[k].high && best->interval[k].low <= second->interval[k].high;
    }
    if (const Choice* cheaper = cheapest_of(unsure, k)) result.perhaps = *cheaper;
    return result;
}

const Choice* least_error(const std::vector<const Choice*>& candidates) {
    const auto least = std::min_element(candidates.begin(), candidates.end(),
                                        [](const Choice* a, const Choice* b) { return a->error.high < b->error.high; });
    return least == candidates.end() ? nullptr : *least;
}

// Whether the error of some point that is at least two rungs of the climb coarser, on every axis, is hardly larger.
bool flat(const Exploration& found, const std::vector<const Choice*>& candidates, const Choice& closest) {
    const std::vector<Axis>& axes = found.families[closest.point.family].axes;
    const int rungs = ladder_rungs(found.families);
    for (const Choice* choice : candidates) {
        if (choice->point.family != closest.point.family) continue;
        bool apart = false;
        bool coarser = true;
        for (std::size_t i = 0; i < axes.size(); ++i) {
            const int distance = closest.point.step[i] - choice->point.step[i];
            const int wanted = std::min(2, rungs) * (axes[i].steps() - 1) / rungs;
            apart = apart || distance > 0;
            coarser = coarser && distance >= wanted;
        }
        if (apart && coarser && closest.error.high > flat_share * choice->error.high) return true;
    }
    return false;
}

// Whether the steps of axes `from` up to `to` are the last ones.
bool last_steps(const Exploration& found, const Point& point, std::size_t from, std::size_t to) {
    const std::vector<Axis>& axes = found.families[point.family].axes;
    for (std::size_t i = from; i < to; ++i)
        if (point.step[i] + 1 < axes[i].steps()) return false;
    return true;
}

Held held(const Exploration& found, const Goal& goal, const std::vector<const Choice*>& own, const Choice& closest,
          const std::vector<Choice>& all) {
    for (const Choice* choice : own)
        if (choice->error.high <= goal.error) return Held::at_most;
    if (found.end == End::given) return Held::given;
    if (flat(found, own, closest)) return Held::bias;
    if (found.end != End::complete) return Held::budget;
    double scout = std::numeric_limits<double>::infinity();
    for (const Choice& choice : all)
        if (found.scout == choice.point.family) scout = std::min(scout, choice.error.high);
    if (found.scout && scout > goal.error) return Held::rays;
    const std::size_t axes = found.families[closest.point.family].axes.size();
    const bool own_axes_end = axes > 2 && last_steps(found, closest.point, 2, axes);
    return own_axes_end || found.scout ? Held::representation : Held::rays;
}

// Whether a setting certainly costs more than the answers in every cost asked, if there are answers.
bool too_dear(const Answer& answer, const Choice& choice) {
    for (std::size_t k = 0; k < costs; ++k) {
        if (!answer.goal.asked[k]) continue;
        if (!answer.cheapest[k] || choice.interval[k].low <= answer.cheapest[k]->best.interval[k].high) return false;
    }
    return true;
}

std::vector<std::string> techniques(const Exploration& found) {
    std::vector<std::string> names;
    for (const Family& family : found.families)
        if (std::find(names.begin(), names.end(), family.technique) == names.end()) names.push_back(family.technique);
    return names;
}

std::vector<const Choice*> of_technique(const Exploration& found, const std::vector<Choice>& all,
                                        const std::string& name) {
    std::vector<const Choice*> own;
    for (const Choice& choice : all)
        if (technique_of(found, choice) == name) own.push_back(&choice);
    return own;
}

std::optional<Broken> broken(const Exploration& found, const std::string& technique) {
    Broken result{technique, 0, 0, {}, {}};
    for (const Measured& measured : found.measured) {
        if (found.families[measured.point.family].technique != technique) continue;
        ++result.measured;
        std::string failed = measured.trial.failed;
        for (const Answered& answered : found.confirmed)
            if (failed.empty() && answered.point == measured.point) failed = answered.confirmed.failed;
        if (failed.empty()) continue;
        if (result.settings++ > 0) continue;
        result.reason = failed;
        result.first = measured.point;
    }
    if (result.settings == 0) return {};
    return result;
}

bool measured(const Exploration& found, const std::string& technique) {
    return std::any_of(found.measured.begin(), found.measured.end(),
                       [&](const Measured& m) { return found.families[m.point.family].technique == technique; });
}

}  // namespace

Answer answer(const Exploration& found, const Goal& goal) {
    Answer result;
    result.goal = goal;
    result.measured = found.measured.size();
    result.confirmed = found.confirmed.size();
    result.end = found.end;
    result.steal = found.steal;
    result.next = found.next;
    result.budget = found.goal.budget;
    const std::vector<Choice> all = choices(found);
    std::vector<const Choice*> good, allowed;
    for (const Choice& choice : all) {
        if (good_enough(choice, goal)) good.push_back(&choice);
        if (within(choice, goal)) allowed.push_back(&choice);
    }
    result.reached = !good.empty();
    std::vector<const Choice*> with_map, without_map;
    for (const Choice* choice : good)
        (found.families[choice->point.family].mapless ? without_map : with_map).push_back(choice);
    for (std::size_t k = 0; k < costs; ++k)
        if (goal.asked[k])
            result.cheapest[k] = cheapest(found, static_cast<Cost>(k) == Cost::lookup ? good : with_map, k);
    if (const Choice* least = cheapest_of(without_map, static_cast<std::size_t>(Cost::lookup)))
        result.without_map = *least;
    result.cut = std::any_of(found.confirmed.begin(), found.confirmed.end(),
                             [](const Answered& answered) { return answered.confirmed.cut; });
    if (!result.reached)
        if (const Choice* closest = least_error(allowed)) result.closest = *closest;
    for (const std::string& name : techniques(found)) {
        if (std::optional<Broken> one = broken(found, name))
            result.broken.push_back(std::move(*one));
        else if (!measured(found, name))
            result.missed.push_back({name, Held::budget, {}});
        const std::vector<const Choice*> own = of_technique(found, all, name);
        const Choice* closest = least_error(own);
        if (!closest) continue;
        if (std::any_of(own.begin(), own.end(), [&](const Choice* c) { return good_enough(*c, goal); })) continue;
        Held reason = held(found, goal, own, *closest, all);
        if (reason != Held::bias && reason != Held::at_most && reason != Held::given && too_dear(result, *closest))
            reason = Held::dear;
        result.missed.push_back({name, reason, *closest});
    }
    const auto failed = std::count_if(result.broken.begin(), result.broken.end(),
                                      [](const Broken& one) { return one.settings == one.measured; });
    result.techniques = techniques(found).size() - static_cast<std::size_t>(failed);
    result.open = static_cast<std::size_t>(std::count_if(result.missed.begin(), result.missed.end(),
                                                         [](const Missed& one) { return one.held == Held::budget; }));
    return result;
}

std::vector<Curve> curves(const Exploration& found, Cost cost) {
    const std::size_t k = static_cast<std::size_t>(cost);
    const std::vector<Choice> all = choices(found);
    std::vector<Curve> result;
    for (const std::string& name : techniques(found)) {
        const std::vector<const Choice*> own = of_technique(found, all, name);
        std::vector<metrics::CostAndError> values;
        for (const Choice* choice : own) values.push_back({choice->cost[k], choice->error.high});
        const std::vector<bool> front = metrics::pareto_front(values);
        Curve curve{name, {}};
        for (std::size_t i = 0; i < own.size(); ++i)
            if (front[i]) curve.points.push_back(*own[i]);
        std::stable_sort(curve.points.begin(), curve.points.end(),
                         [](const Choice& a, const Choice& b) { return a.error.high > b.error.high; });
        result.push_back(std::move(curve));
    }
    return result;
}

}  // namespace shadowbench::recommend
