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

// A point is left unmeasured if its chance to be the best is below the first, and that of a better runner-up below the
// second.
constexpr double leader_chance = 0.03, follower_chance = 0.15;
// Smaller gains are not looked for, as a share of the cost: where a technique leads, and where it follows.
constexpr std::array<double, costs> least_gain{0.04, 0.002, 0.04};
constexpr double follower_gain = 0.1;
// A climb leaves out rungs whose light rays make the scout err by more than the error asked for over this. The scout
// sees only the rays inside a footprint, so other filters may err less; refining may come back to such rays.
constexpr double scout_slack = 0.5;
// A climb ends if its error would stay too large even if the rungs left lowered it so many times faster.
constexpr double faster = 2.0;
// Or if others were built from the light rays of the next rung, and the model gives it a chance below this.
constexpr double climbing_chance = 0.02;
// Faithful families climb before others that take up to this times less effort: what light rays leave is then known.
constexpr double faithful_first = 2.0;
// A probe beside the climbs may take this share of the time left.
constexpr double probe_share = 0.1;
// Refining ends if going on for as long as everything has taken so far promises to gain less than this, as a share of
// the costs.
constexpr double least_promise = 0.03;
constexpr double coarse_share = 0.35;  // of the time, after which points between the coarse ones count too
constexpr int confirm_rounds = 8;
constexpr double first_round_share = 0.6;  // of the time left to confirm: other rounds may follow

class Search {
public:
    Search(Lab& lab, const Goal& goal, const Hooks& hooks);

    Exploration run();

private:
    bool out_of_time(double share);
    bool stopped(double share);
    double left(double share) const;
    bool fits(double seconds) const { return seconds <= left(exploring_share); }
    void measure(const Point& point);
    void note_floor(const Point& point, double error);
    std::array<double, costs> limits(std::size_t family) const;
    void update_one(std::size_t family);
    void update(std::size_t family);
    void update_all();

    bool too_dear(std::size_t family, std::size_t index) const;
    bool too_few_rays(std::size_t family, const Point& point) const;
    std::optional<std::size_t> next_climb(std::size_t family) const;
    void climb();

    struct Open {
        std::size_t index;
        double gain;
    };
    std::optional<Point> best_witness() const;
    void probe();
    double gain(std::size_t family, std::size_t index, bool likely) const;
    bool answered() const;
    const std::vector<Open>& open_points(std::size_t family);
    void share_floors(std::size_t family);
    std::optional<Point> most_promising(std::size_t& open, bool& too_long);
    std::optional<Point> seemingly_most_promising(std::size_t& open, bool& too_long);
    std::optional<Point> open_neighbour(bool& too_long) const;
    void refine();

    void confirm();

    void report(Stage stage, std::size_t open) const;

    Lab& lab_;
    const Hooks& hooks_;
    double began_;
    double spent_ = 1e-9;  // seconds of measuring, as foreseen
    Exploration found_;
    Wanted wanted_;
    std::vector<Knowledge> families_;
    Floors floors_;
    std::vector<std::size_t> shared_;  // the version of the floors that each family was brought up to date with
    struct Climb {
        std::vector<Point> rungs;
        std::size_t next = 0;      // the first rung not yet tried
        std::size_t measured = 0;  // rungs: the first records of the family
    };
    std::vector<Climb> climbs_;  // of every family
    std::vector<std::optional<std::vector<Open>>> open_;  // of every family; nothing if it must be found again
    Incumbents incumbents_{};
    bool fine_ = false;  // whether all points count, or only coarse ones
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
        open_.emplace_back();
        shared_.push_back(0);
        climbs_.push_back({ladder(found_.families[i], i, rungs)});
    }
}

bool Search::out_of_time(double share) {
    if (left(share) > 0.0) return false;
    if (found_.end == End::complete) found_.end = End::budget;
    return true;
}

// Seconds until this share is spent of the budget that was left at the start.
double Search::left(double share) const {
    if (!hooks_.seconds || std::isinf(found_.goal.budget)) return infinity;
    return began_ + share * (found_.goal.budget - began_) - hooks_.seconds();
}

bool Search::stopped(double share) {
    if (hooks_.cancelled && hooks_.cancelled()) found_.end = End::cancelled;
    return found_.end == End::cancelled || out_of_time(share);
}

void Search::report(Stage stage, std::size_t open) const {
    if (hooks_.progress) hooks_.progress({stage, found_.measured.size(), open});
}

void Search::measure(const Point& point) {
    spent_ += lab_.effort(point);
    Trial trial = lab_.measure(point);
    if (trial.failed.empty() && !std::isfinite(trial.error)) trial.failed = "its error is not finite";
    families_[point.family].add(point, trial);
    if (trial.failed.empty()) note_floor(point, trial.error);
    found_.measured.push_back({point, std::move(trial)});
    update(point.family);
}

// If the light rays of this point certainly err too much, they do so for all families.
void Search::note_floor(const Point& point, double error) {
    const Family& family = found_.families[point.family];
    const Floor* floor = floors_.add(family, point, error);
    if (!floor || floor->error * floor_slack <= wanted_.error) return;
    for (std::size_t i = 0; i < families_.size(); ++i) {
        if (!same_light_rays(found_.families[i], family)) continue;
        families_[i].bound_by(floors_.known());
        if (i != point.family) update_one(i);
    }
}

// What a point of this family must cost less than to matter. Trials of times are smoothed, so the limit may rise a
// little before the family is updated again.
std::array<double, costs> Search::limits(std::size_t family) const {
    std::array<double, costs> result{};
    for (std::size_t k = 0; k < costs; ++k)
        if (found_.goal.asked[k]) result[k] = incumbents_.limit(found_.families[family], k).cost * cost_noise[k];
    return result;
}

void Search::update_one(std::size_t family) {
    families_[family].update(wanted_, fine_, limits(family));
    open_[family].reset();
}

void Search::update(std::size_t family) {
    share_floors(family);
    const Incumbents before = std::exchange(incumbents_, find_incumbents(found_.families, families_));
    if (!(before == incumbents_))
        for (auto& open : open_) open.reset();
}

// After a change of what is wanted: what was out of question may not be any more.
void Search::update_all() {
    for (Knowledge& family : families_) family.want(wanted_);
    incumbents_ = find_incumbents(found_.families, families_);
    for (std::size_t i = 0; i < families_.size(); ++i) update_one(i);
    incumbents_ = find_incumbents(found_.families, families_);
}

// Whether this point, and all that are more accurate, certainly cost more than what is known, in every cost asked.
bool Search::too_dear(std::size_t family, std::size_t index) const {
    for (std::size_t k = 0; k < costs; ++k)
        if (found_.goal.asked[k] &&
            families_[family].least(index, static_cast<Cost>(k)) < incumbents_.limit(found_.families[family], k).cost)
            return false;
    return true;
}

// Whether the scout errs so much with these light rays, or more of them, that a climb may begin above.
bool Search::too_few_rays(std::size_t family, const Point& point) const {
    if (!found_.scout || family == *found_.scout ||
        !same_light_rays(found_.families[family], found_.families[*found_.scout]))
        return false;
    const std::span<const Record> records = families_[*found_.scout].records();
    return std::any_of(records.begin(), records.end(), [&](const Record& record) {
        return record.failed.empty() && record.error * scout_slack > wanted_.error && point.step[0] <= record.step[0] &&
               point.step[1] <= record.step[1];
    });
}

// The next rung of a family's climb; nothing if it is done. Rungs that are ruled out, or have too few rays, are left out.
std::optional<std::size_t> Search::next_climb(std::size_t family) const {
    const Knowledge& known = families_[family];
    const std::span<const Record> records = known.records();
    const Climb& climb = climbs_[family];
    if (known.left_out()) return {};
    if (climb.measured >= 1 && known.acceptable(records[climb.measured - 1])) return {};
    if (climb.measured >= 3) {
        const Record &last = records[climb.measured - 1], &before = records[climb.measured - 3];
        if (last.failed.empty() && before.failed.empty() && last.error > flat_share * before.error) return {};
    }
    if (climb.measured >= 2) {
        const Record &last = records[climb.measured - 1], &before = records[climb.measured - 2];
        const double left = static_cast<double>(climb.rungs.size() - climb.next);
        if (last.failed.empty() && before.failed.empty() && last.error > wanted_.trial_error &&
            last.error * std::pow(last.error / before.error, faster * left) > wanted_.trial_error)
            return {};
    }
    for (std::size_t rung = climb.next; rung < climb.rungs.size(); ++rung) {
        const std::size_t index = known.lattice().index(climb.rungs[rung].step);
        if (too_dear(family, index)) return {};
        if (climb.measured >= 2 && known.borrowed_at(climb.rungs[rung]) && known.chance_there(index) < climbing_chance)
            return {};
        if (!known.ruled_out(index) && !too_few_rays(family, climb.rungs[rung])) return rung;
    }
    return {};
}

// The scout climbs first: the others begin where its light rays may do.
void Search::climb() {
    while (!stopped(exploring_share)) {
        std::optional<std::size_t> chosen;
        double least = infinity;
        std::size_t climbing = 0;
        bool too_long = false;
        for (std::size_t i = 0; i < families_.size(); ++i) {
            const std::optional<std::size_t> rung = next_climb(i);
            if (!rung) continue;
            ++climbing;
            const double seconds = lab_.effort(climbs_[i].rungs[*rung]);
            if (!fits(seconds)) {
                too_long = true;
                continue;
            }
            const double effort = seconds * (found_.families[i].faithful ? 1.0 : faithful_first);
            if (chosen && found_.scout == chosen) continue;
            if (effort >= least && found_.scout != i) continue;
            least = effort;
            chosen = i;
        }
        if (!chosen) {
            if (too_long && found_.end == End::complete) found_.end = End::budget;
            return;
        }
        if (shared_[*chosen] != floors_.version()) {  // what others reached may end this climb
            share_floors(*chosen);
            continue;
        }
        report(Stage::climbing, climbing);
        Climb& climb = climbs_[*chosen];
        const std::size_t rung = *next_climb(*chosen);
        measure(climb.rungs[rung]);
        climb.next = rung + 1;
        ++climb.measured;
    }
}

// The faithful family that errs least with any light rays, and its light rays there: those of the least settings that
// are good enough, or else the finest.
std::optional<Point> Search::best_witness() const {
    std::optional<Point> best;
    double error = infinity;
    bool enough = false;
    for (std::size_t f = 0; f < families_.size(); ++f) {
        if (!found_.families[f].faithful) continue;
        for (const Record& record : families_[f].records()) {
            if (!record.failed.empty()) continue;
            const bool good = families_[f].acceptable(record);
            const bool fewer = best && (record.step[0] < best->step[0] || record.step[1] < best->step[1]);
            const bool same = best && record.step[0] == best->step[0] && record.step[1] == best->step[1];
            if (!best || (good && !enough) || (good == enough && (same ? record.error < error : good == fewer))) {
                best = Point{f, record.step};
                error = record.error;
                enough = good;
            }
        }
    }
    return best;
}

// Climbs go along one line: resolution and samples rise together. A faithful family looks to both sides of it, at about
// as many light rays: coarser maps with more samples, and finer ones with fewer. What it finds there tells all families
// which light rays may suffice.
void Search::probe() {
    const std::optional<Point> from = best_witness();
    if (!from) return;
    const Family& family = found_.families[from->family];
    for (const int octaves : {1, 2, 4})
        for (const int side : {-1, 1}) {
            Point point = *from;
            for (std::size_t axis = 0; axis < 2; ++axis) {
                const int moved = point.step[axis] + (axis == 0 ? side : -side) * octaves * family.axes[axis].stride;
                point.step[axis] = std::clamp(moved, 0, family.axes[axis].steps() - 1);
            }
            for (std::size_t axis = 2; axis < family.axes.size(); ++axis)
                point.step[axis] = 3 * (family.axes[axis].steps() - 1) / 4;
            const std::size_t index = families_[from->family].lattice().index(point.step);
            if (families_[from->family].measured(index) || families_[from->family].ruled_out(index)) continue;
            const double seconds = lab_.effort(point);
            if (seconds > probe_share * left(exploring_share) || stopped(exploring_share)) continue;
            report(Stage::refining, 1);
            measure(point);
        }
}

// The expected gain of measuring a point, summed over the costs: how much cheaper it may be than what is known, as a
// logarithm, times the chance of that. If it must be `likely`, chances that are too small do not count.
double Search::gain(std::size_t family, std::size_t index, bool likely) const {
    const Knowledge& known = families_[family];
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
            return known.chance(index) *
                   normal_below((std::log(bound) - estimate.mean - share) / (estimate.sd + 1e-4));
        };
        const double lead = chance_below(limit.leads ? limit.cost : incumbents_.least[k], least_gain[k]);
        const double share = limit.leads ? least_gain[k] : follower_gain;
        const double chance = limit.leads ? lead : chance_below(limit.cost, share);
        if (likely && lead < leader_chance && (limit.leads || chance < follower_chance)) continue;
        const bool known_size = std::isfinite(limit.cost) && std::isfinite(estimate.sd);
        sum += chance * (known_size ? std::clamp(std::log(limit.cost) - estimate.mean, share, 1.0) : 1.0);
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

// Brings a family up to date with what others reached.
void Search::share_floors(std::size_t family) {
    families_[family].borrow(floors_.all());
    shared_[family] = floors_.version();
    update_one(family);
}

// What others reached since a family was last updated makes its points less promising, rarely more. So only the family
// of the most promising point is brought up to date, until the most promising point is of a family that is.
std::optional<Point> Search::most_promising(std::size_t& open, bool& too_long) {
    for (;;) {
        const std::optional<Point> best = seemingly_most_promising(open, too_long);
        if (!best || shared_[best->family] == floors_.version()) return best;
        share_floors(best->family);
    }
}

std::optional<Point> Search::seemingly_most_promising(std::size_t& open, bool& too_long) {
    std::optional<Point> best;
    double most = 0.0;
    open = 0;
    for (std::size_t f = 0; f < families_.size(); ++f)
        for (const Open& one : open_points(f)) {
            ++open;
            const Point& point = families_[f].lattice().point(one.index);
            const double effort = lab_.effort(point), worth = one.gain / effort;
            if (worth <= std::max(most, least_promise / spent_)) continue;
            if (!fits(effort)) {
                too_long = true;
                continue;
            }
            most = worth;
            best = point;
        }
    return best;
}

// A neighbour of a best setting that nothing measured rules out: one step cheaper on an axis, and perhaps one step more
// accurate on another.
std::optional<Point> Search::open_neighbour(bool& too_long) const {
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
                if (fits(lab_.effort(point))) return point;
                too_long = true;
            }
    }
    return {};
}

void Search::refine() {
    while (!stopped(exploring_share)) {
        std::size_t open = 0;
        bool too_long = false;
        std::optional<Point> next = most_promising(open, too_long);
        if (!fine_ && (!next || (left(coarse_share) <= 0.0 && answered()))) {
            fine_ = true;
            update_all();
            continue;
        }
        if (!next) next = open_neighbour(too_long);
        if (!next) {
            if (too_long && found_.end == End::complete) found_.end = End::budget;
            return;
        }
        report(Stage::refining, std::max<std::size_t>(open, 1));
        measure(*next);
    }
}

void Search::confirm() {
    double seconds_a_point = 0.0;
    for (int round = 0; round < confirm_rounds; ++round) {
        // The first round is due even if the budget is spent: without it there is no answer.
        if (round == 0 ? stopped(infinity) : stopped(1.0)) return;
        const std::vector<Point> points = to_confirm(found_.families, families_, found_.goal.asked, incumbents_);
        if (points.empty()) return;
        if (static_cast<double>(points.size()) * seconds_a_point > left(1.0)) {
            found_.end = End::budget;
            return;
        }
        report(Stage::confirming, points.size());
        const double before = left(1.0);
        const std::vector<Confirmed> answers =
            lab_.confirm(points, found_.goal.error, (round == 0 ? first_round_share : 1.0) * std::max(before, 0.0));
        if (std::isfinite(before)) seconds_a_point = (before - left(1.0)) / static_cast<double>(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            families_[points[i].family].confirm(points[i], answers[i]);
            std::erase_if(found_.confirmed, [&](const Answered& a) { return a.point == points[i]; });
            found_.confirmed.push_back({points[i], answers[i]});
        }
        wanted_.trial_error = found_.goal.error / growth(found_);
        update_all();
        refine();
    }
}

Exploration Search::run() {
    climb();
    probe();
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
