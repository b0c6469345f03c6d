#include "recommend/search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "recommend/incumbents.h"
#include "recommend/knowledge.h"
#include "recommend/ladder.h"

namespace shadowbench::recommend {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A point is left unmeasured if its chance of a gain is below this.
constexpr double least_chance = 0.05;
// Smaller gains are not looked for, as a share of the cost: where a technique leads, and where it follows.
constexpr std::array<double, costs> least_gain{0.04, 0.002, 0.04};
constexpr double follower_gain = 0.1;
constexpr int confirm_rounds = 8;

class Search {
public:
    Search(Lab& lab, const Goal& goal, const Hooks& hooks);

    Exploration run();

private:
    bool out_of_time(double share);
    bool stopped(double share);
    void measure(const Point& point);
    void update(std::size_t family);

    std::optional<Point> next_climb(std::size_t family) const;
    void climb();

    double gain(std::size_t family, std::size_t index, double least) const;
    std::optional<Point> most_promising(std::size_t& open) const;
    std::optional<Point> open_neighbour() const;
    void refine();

    void confirm();

    void report(Stage stage, std::size_t open) const;

    Lab& lab_;
    const Hooks& hooks_;
    double began_;
    Exploration found_;
    Wanted wanted_;
    std::vector<Knowledge> families_;
    std::vector<std::vector<Point>> ladders_;  // of every family, the points of its climb
    std::vector<std::size_t> rungs_;           // climbed so far
    Incumbents incumbents_;
};

bool same_light_rays(const Family& a, const Family& b) {
    return a.axes[0].values == b.axes[0].values && a.axes[1].values == b.axes[1].values;
}

Search::Search(Lab& lab, const Goal& goal, const Hooks& hooks)
    : lab_(lab), hooks_(hooks), began_(hooks.seconds ? hooks.seconds() : 0.0) {
    found_.goal = goal;
    found_.families = {lab.families().begin(), lab.families().end()};
    found_.scout = lab.scout();
    wanted_ = {goal.error, goal.error, goal.at_most};
    const int rungs = ladder_rungs(found_.families);
    for (std::size_t i = 0; i < found_.families.size(); ++i) {
        families_.emplace_back(found_.families[i], i, lab);
        ladders_.push_back(ladder(found_.families[i], i, rungs));
    }
    rungs_.assign(families_.size(), 0);
}

bool Search::out_of_time(double share) {
    if (!hooks_.seconds || hooks_.seconds() - began_ < share * found_.goal.budget) return false;
    if (found_.end == End::complete) found_.end = End::budget;
    return true;
}

bool Search::stopped(double share) {
    if (hooks_.cancelled && hooks_.cancelled()) found_.end = End::cancelled;
    return found_.end == End::cancelled || out_of_time(share);
}

void Search::report(Stage stage, std::size_t open) const {
    if (hooks_.progress) hooks_.progress({stage, found_.measured.size(), open});
}

void Search::measure(const Point& point) {
    Trial trial = lab_.measure(point);
    if (trial.failed.empty() && !std::isfinite(trial.error)) trial.failed = "its error is not finite";
    families_[point.family].add(point, trial);
    found_.measured.push_back({point, std::move(trial)});
    update(point.family);
}

void Search::update(std::size_t family) {
    families_[family].update(wanted_);
    if (found_.scout == family)
        for (std::size_t i = 0; i < families_.size(); ++i)
            if (i != family && same_light_rays(found_.families[i], found_.families[family])) {
                families_[i].bound_by(families_[family].records());
                families_[i].update(wanted_);
            }
    incumbents_ = find_incumbents(found_.families, families_);
}

// The next point of a family's climb; nothing if it is done.
std::optional<Point> Search::next_climb(std::size_t family) const {
    const std::span<const Record> records = families_[family].records();
    const std::size_t rung = rungs_[family];
    if (rung == ladders_[family].size() || families_[family].left_out()) return {};
    if (rung >= 1 && families_[family].acceptable(records[rung - 1])) return {};
    if (rung >= 3) {
        const Record &last = records[rung - 1], &before = records[rung - 3];
        if (last.failed.empty() && before.failed.empty() && last.error > flat_share * before.error) return {};
    }
    return ladders_[family][rung];
}

void Search::climb() {
    while (!stopped(exploring_share)) {
        std::optional<Point> next;
        double least = infinity;
        std::size_t climbing = 0;
        for (std::size_t i = 0; i < families_.size(); ++i) {
            const std::optional<Point> point = next_climb(i);
            if (!point) continue;
            ++climbing;
            const double effort = lab_.effort(*point);
            if (effort >= least) continue;
            least = effort;
            next = point;
        }
        if (!next) return;
        report(Stage::climbing, climbing);
        measure(*next);
        ++rungs_[next->family];
    }
}

// The expected gain of measuring a point, summed over the costs: how much cheaper it may be than what is known, as a
// logarithm, times the chance of that. 0 if no chance is at least `least`.
double Search::gain(std::size_t family, std::size_t index, double least) const {
    const Knowledge& known = families_[family];
    double sum = 0.0;
    for (std::size_t k = 0; k < costs; ++k) {
        if (!found_.goal.asked[k]) continue;
        const Cost cost = static_cast<Cost>(k);
        const Incumbents::Limit limit = incumbents_.limit(found_.families[family].technique, k);
        if (known.least(index, cost) >= limit.cost) continue;
        const double wanted_gain = limit.leads ? least_gain[k] : std::max(follower_gain, least_gain[k]);
        double chance = known.chance(index), size = 1.0;
        const Estimate& estimate = known.cost(index, cost);
        if (std::isfinite(limit.cost) && std::isfinite(estimate.sd)) {
            const double room = std::log(limit.cost) - estimate.mean;
            chance *= normal_below((room - wanted_gain) / (estimate.sd + 1e-4));
            size = std::clamp(room, wanted_gain, 1.0);
        }
        if (chance >= least) sum += chance * size;
    }
    return sum;
}

std::optional<Point> Search::most_promising(std::size_t& open) const {
    std::optional<Point> best;
    double most = 0.0;
    open = 0;
    for (std::size_t f = 0; f < families_.size(); ++f) {
        const Knowledge& known = families_[f];
        for (std::size_t i = 0; i < known.lattice().size(); ++i) {
            if (known.measured(i) || known.ruled_out(i)) continue;
            const double gained = gain(f, i, least_chance);
            if (gained <= 0.0) continue;
            ++open;
            const Point& point = known.lattice().point(i);
            const double worth = gained / lab_.effort(point);
            if (worth <= most) continue;
            most = worth;
            best = point;
        }
    }
    return best;
}

// A neighbour of a best setting that nothing measured rules out: one step cheaper on an axis, and perhaps one step more
// accurate on another.
std::optional<Point> Search::open_neighbour() const {
    for (std::size_t k = 0; k < costs; ++k) {
        if (!found_.goal.asked[k] || !incumbents_.best[k]) continue;
        const Point& best = *incumbents_.best[k];
        const Knowledge& known = families_[best.family];
        const Lattice& lattice = known.lattice();
        for (std::size_t down = 0; down < lattice.axes(); ++down)
            for (std::size_t up = 0; up < lattice.axes(); ++up) {
                Point point = best;
                if (--point.step[down] < 0) continue;
                if (up != down && ++point.step[up] == lattice.steps(up)) continue;
                const std::size_t index = lattice.index(point.step);
                if (!known.measured(index) && !known.ruled_out(index) && gain(best.family, index, 0.0) > 0.0)
                    return point;
            }
    }
    return {};
}

void Search::refine() {
    while (!stopped(exploring_share)) {
        std::size_t open = 0;
        std::optional<Point> next = most_promising(open);
        if (!next) next = open_neighbour();
        if (!next) return;
        report(Stage::refining, std::max<std::size_t>(open, 1));
        measure(*next);
    }
}

void Search::confirm() {
    for (int round = 0; round < confirm_rounds; ++round) {
        // The first round is due even if the budget is spent: without it there is no answer.
        if (round == 0 ? stopped(infinity) : stopped(1.0)) return;
        const std::vector<Point> points = to_confirm(found_.families, families_, found_.goal.asked, incumbents_);
        if (points.empty()) return;
        report(Stage::confirming, points.size());
        const std::vector<Confirmed> answers = lab_.confirm(points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            families_[points[i].family].confirm(points[i], answers[i]);
            std::erase_if(found_.confirmed, [&](const Answered& a) { return a.point == points[i]; });
            found_.confirmed.push_back({points[i], answers[i]});
        }
        wanted_.trial_error = found_.goal.error / growth(found_);
        for (std::size_t i = 0; i < families_.size(); ++i) update(i);
        refine();
    }
}

Exploration Search::run() {
    climb();
    refine();
    confirm();
    return std::move(found_);
}

}  // namespace

Exploration explore(Lab& lab, const Goal& goal, const Hooks& hooks) {
    using base::Error;
    using base::ErrorCode;
    if (!(goal.error > 0.0) || !std::isfinite(goal.error))
        throw Error(ErrorCode::usage, "--error", "the error asked for must be above 0");
    if (!(goal.budget > 0.0)) throw Error(ErrorCode::usage, "--budget", "the budget must be above 0 seconds");
    if (std::none_of(goal.asked.begin(), goal.asked.end(), [](bool asked) { return asked; }))
        throw Error(ErrorCode::usage, "--cheapest", "ask for the least lookup time, bytes or build time");
    return Search(lab, goal, hooks).run();
}

}  // namespace shadowbench::recommend
