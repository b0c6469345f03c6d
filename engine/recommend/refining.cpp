// The second step of a search: the point with the most expected gain for its effort comes next.
#include <algorithm>
#include <cmath>
#include <limits>

#include "recommend/search_steps.h"

namespace shadowbench::recommend {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A point is left unmeasured if its chance to be the best is below the first, and that of a better runner-up below the
// second.
constexpr double leader_chance = 0.03, follower_chance = 0.15;
// Smaller gains are not looked for, as a share of the cost: where a technique leads, and where it follows.
constexpr std::array<double, costs> least_gain{0.04, 0.002, 0.04};
constexpr double follower_gain = 0.1;
// If time is limited, how much a gain of a runner-up counts beside the same gain of the best: it is no answer, only
// what another technique would cost.
constexpr double follower_weight = 0.25;
// Refining ends if going on for as long as everything has taken so far promises to gain less than this, as a share of
// the costs.
constexpr double least_promise = 0.03;
constexpr double variant_share = 0.1;  // of the time left, that a variant of a best setting may take
constexpr double coarse_share = 0.35;  // of the time, after which points between the coarse ones count too

}  // namespace

// The expected gain of measuring a point, summed over the costs: how much cheaper it may be than what is known, as a
// logarithm, times the chance of that. If it must be `likely`, chances that are too small do not count.
double Search::gain(std::size_t family, std::size_t index, bool likely) const {
    const Knowledge& known = families_[family];
    const double weight = std::isfinite(found_.goal.budget) ? follower_weight : 1.0;
    double sum = 0.0;
    for (std::size_t k = 0; k < costs; ++k) {
        if (!found_.goal.asked[k]) continue;
        const Cost cost = static_cast<Cost>(k);
        const Incumbents::Limit limit = incumbents_.limit(found_.families[family], k);
        if (known.least(index, cost) >= limit.cost) continue;
        const Estimate& estimate = known.cost(index, cost);
        // The chance to cost less than a limit by some share of it.
        const auto chance_below = [&](double bound, double share) {
            if (!std::isfinite(bound) || !std::isfinite(estimate.sd)) return known.chance(index);
            return known.chance(index) * normal_below((std::log(bound) - estimate.mean - share) / (estimate.sd + 1e-4));
        };
        const double lead = chance_below(limit.leads ? limit.cost : incumbents_.least[k], least_gain[k]);
        const double share = limit.leads ? least_gain[k] : follower_gain;
        const double chance = limit.leads ? lead : chance_below(limit.cost, share);
        if (likely && lead < leader_chance && (limit.leads || chance < follower_chance)) continue;
        // `size`: the logarithm of how much cheaper the point may be than a bound.
        const auto size = [&](double bound, double least) {
            const bool known_size = std::isfinite(bound) && std::isfinite(estimate.sd);
            return known_size ? std::clamp(std::log(bound) - estimate.mean, least, 1.0) : 1.0;
        };
        if (limit.leads)
            sum += chance * size(limit.cost, share);
        else
            sum += weight * chance * size(limit.cost, share) +
                   (1.0 - weight) * lead * size(incumbents_.least[k], least_gain[k]);
    }
    return sum;
}

// Whether something is good enough for every cost asked.
bool Search::answered() const {
    for (std::size_t k = 0; k < costs; ++k)
        if (found_.goal.asked[k] && !incumbents_.best[k]) return false;
    return true;
}

// The points of a family that may gain something.
const std::vector<Search::Open>& Search::open_points(std::size_t family) {
    if (open_[family]) return *open_[family];
    std::vector<Open>& open = open_[family].emplace();
    const Knowledge& known = families_[family];
    for (std::size_t i = 0; i < known.lattice().size(); ++i) {
        if (known.measured(i) || known.ruled_out(i) || known.chance(i) <= 0.0) continue;
        const double gained = gain(family, i, true);
        if (gained > 0.0) open.push_back({i, gained});
    }
    return open;
}

// What others reached since a family was last updated makes its points less promising, rarely more. So only the family
// of the most promising point is brought up to date, until the most promising point is of a family that is.
std::optional<Point> Search::most_promising(std::size_t& open, double& skipped) {
    for (;;) {
        const std::optional<Point> best = seemingly_most_promising(open, skipped);
        if (!best || shared_[best->family] == floors_.version()) return best;
        share_floors(best->family);
    }
}

std::optional<Point> Search::seemingly_most_promising(std::size_t& open, double& skipped) {
    std::optional<Point> best;
    double most = 0.0;
    open = 0;
    for (std::size_t f = 0; f < families_.size(); ++f)
        for (const Open& one : open_points(f)) {
            ++open;
            // Efforts take long to foresee for so many points.
            if (one.gain <= lab_.least_effort() * std::max(most, least_promise / spent_)) continue;
            const Point& point = families_[f].lattice().point(one.index);
            const double effort = lab_.effort(point), worth = one.gain / effort;
            if (worth <= std::max(most, least_promise / spent_)) continue;
            if (!fits(effort)) {
                skipped = std::min(skipped, effort);
                continue;
            }
            most = worth;
            best = point;
        }
    return best;
}

// A neighbour of a best setting that nothing measured rules out: one step cheaper on an axis, and perhaps one step more
// accurate on another.
std::optional<Point> Search::open_neighbour(double& skipped) const {
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
                if (known.measured(index) || known.ruled_out(index) || gain(best.family, index, false) <= 0.0) continue;
                const double effort = lab_.effort(point);
                if (fits(effort)) return point;
                skipped = std::min(skipped, effort);
            }
    }
    return {};
}

// A best setting that nothing measured rules out once one thing of it is changed: one of its technique's own parameters
// by a step to the cheaper side, or its words, as another kernel. Words have no order and each choice has a model of
// its own, so what is known of one says little of another. The light rays are the same, and often the map, so that this
// takes little time.
std::optional<Point> Search::open_variant() const {
    const auto open = [&](const Point& point) {
        const Knowledge& known = families_[point.family];
        const std::size_t index = known.lattice().index(point.step);
        return !known.measured(index) && !known.ruled_out(index) && lab_.effort(point) <= variant_share * left();
    };
    for (std::size_t k = 0; k < costs; ++k) {
        if (!found_.goal.asked[k] || !incumbents_.best[k]) continue;
        const Point& best = *incumbents_.best[k];
        const Family& family = found_.families[best.family];
        for (std::size_t axis = 2; axis < family.axes.size(); ++axis) {
            Point point = best;
            if (--point.step[axis] >= 0 && open(point)) return point;
        }
        for (std::size_t f = 0; f < families_.size(); ++f) {
            const Family& other = found_.families[f];
            const auto same_values = [](const Axis& a, const Axis& b) { return a.values == b.values; };
            if (f == best.family || other.technique != family.technique || families_[f].left_out() ||
                !std::equal(family.axes.begin(), family.axes.end(), other.axes.begin(), other.axes.end(), same_values))
                continue;
            if (open({f, best.step})) return Point{f, best.step};
        }
    }
    return {};
}

void Search::try_variants() {
    for (std::optional<Point> next; !stopped() && (next = open_variant());) {
        report(Stage::refining, 1);
        measure(*next);
    }
}

void Search::refine() {
    skipped_point_ = infinity;
    while (!exploring_over()) {
        std::size_t open = 0;
        double skipped = infinity;
        std::optional<Point> next = most_promising(open, skipped);
        if (!fine_ && (!next || (left() < (1.0 - coarse_share) * whole_time() && answered()))) {
            fine_ = true;
            update_all();
            continue;
        }
        if (!next) next = open_neighbour(skipped);
        if (!next) {
            skipped_point_ = skipped;
            if (std::isfinite(skipped) && found_.end == End::complete) found_.end = End::budget;
            return;
        }
        report(Stage::refining, std::max<std::size_t>(open, 1));
        measure(*next);
    }
}

}  // namespace shadowbench::recommend
