#include "recommend/search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "base/error.h"
#include "recommend/ladder.h"
#include "recommend/search_steps.h"

namespace shadowbench::recommend {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t not_shared = std::numeric_limits<std::size_t>::max();

constexpr int confirm_rounds = 8;
constexpr double first_round_share = 0.6;  // of the time left to confirm: other rounds may follow
// A point that is not the best known is confirmed only if it takes at most this share of the round's time.
constexpr double other_share = 0.2;
// A safe point, which stands in for a best one that turns out to err too much, at most this.
constexpr double safe_share = 0.3;
// Of the whole time, that timing lookups again may take, but at most this share of the time left; and how many are.
constexpr double again_share = 0.1, again_share_left = 0.3;
constexpr std::size_t most_again = 12;
constexpr double seconds_again = 0.3;  // of one, besides building its map
// Of the whole time, that exploring leaves at least and at most; in between it leaves so many times what confirming the
// best settings takes.
constexpr double least_reserve = 0.25, most_reserve = 0.45, reserved_rounds = 1.6;

}  // namespace

Search::Search(Lab& lab, const Goal& goal, const Hooks& hooks)
    : lab_(lab), hooks_(hooks), began_(hooks.seconds ? hooks.seconds() : 0.0) {
    found_.goal = goal;
    found_.before = began_;
    found_.families = {lab.families().begin(), lab.families().end()};
    found_.scout = lab.scout();
    wanted_ = {goal.error, goal.error / growth(found_), goal.at_most};
    const int rungs = ladder_rungs(found_.families);
    for (std::size_t i = 0; i < found_.families.size(); ++i) {
        families_.emplace_back(found_.families[i], i, lab);
        open_.emplace_back();
        shared_.push_back(0);
        climbs_.push_back({ladder(found_.families[i], i, rungs)});
    }
}

// Seconds.
double Search::whole_time() const {
    return found_.goal.budget - began_;
}

double Search::left() const {
    if (!hooks_.seconds || std::isinf(found_.goal.budget)) return infinity;
    return found_.goal.budget - hooks_.seconds();
}

// What confirming the best settings takes, and a second round, and timing lookups again.
double Search::reserve() const {
    if (std::isinf(left())) return 0.0;
    std::vector<Point> points;
    for (std::size_t k = 0; k < costs; ++k) {
        const std::optional<Point>& best = incumbents_.best[k];
        if (found_.goal.asked[k] && best && std::find(points.begin(), points.end(), *best) == points.end())
            points.push_back(*best);
    }
    double seconds = again_share * whole_time(), once = 0.0;
    for (const Point& point : points) once += lab_.confirm_effort(point, {});
    if (!found_.confirmed.empty()) return once;  // what is found after the first round is confirmed in one
    seconds += reserved_rounds * once;
    return std::clamp(seconds, least_reserve * whole_time(), most_reserve * whole_time());
}

bool Search::cancelled() {
    if (hooks_.cancelled && hooks_.cancelled()) found_.end = End::cancelled;
    return found_.end == End::cancelled;
}

bool Search::stopped() {
    if (cancelled()) return true;
    if (left() > 0.0) return false;
    if (found_.end == End::complete) found_.end = End::budget;
    return true;
}

bool Search::exploring_over() {
    if (cancelled()) return true;
    reserve_ = reserve();
    if (left_to_explore() > 0.0) return false;
    if (found_.end == End::complete) found_.end = End::budget;
    return true;
}

void Search::report(Stage stage, std::size_t open) const {
    if (hooks_.progress) hooks_.progress({stage, found_.measured.size(), open});
}

void Search::measure(const Point& point) {
    spent_ += lab_.effort(point);
    Trial trial = lab_.measure(point);
    if (trial.failed.empty() && !std::isfinite(trial.error)) trial.failed = "its error is not finite";
    families_[point.family].add(point, trial);
    if (trial.failed.empty()) {
        note_floor(point, trial.error);
        tell_alike(point, trial.error);
    }
    found_.measured.push_back({point, std::move(trial)});
    update(point.family);
}

// Families that answer alike err as this one does. They are brought up to date when one of their points comes next.
void Search::tell_alike(const Point& point, double error) {
    const auto first = [&](std::size_t family) { return found_.families[family].answers_as.value_or(family); };
    for (std::size_t i = 0; i < families_.size(); ++i) {
        if (i == point.family || first(i) != first(point.family)) continue;
        families_[i].add_answer(point.step, error);
        shared_[i] = not_shared;
    }
}

// If the light rays of this point certainly err too much, they do so for all families.
void Search::note_floor(const Point& point, double error) {
    const Family& family = found_.families[point.family];
    const std::optional<Floor> floor = floors_.add(family, point, error);
    if (!floor || !floor->exceeds(wanted_.error)) return;
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

// Brings a family up to date with what others reached.
void Search::share_floors(std::size_t family) {
    families_[family].borrow(floors_.all());
    shared_[family] = floors_.version();
    update_one(family);
}

// Trials time one map at a time, so that they rank lookups by chance that differ by less than the machine's noise. The
// fastest are timed again in turns before a few of them are confirmed; and then those that seemed slower than the
// fastest, if it turns out to be slower than they seemed.
void Search::time_again() {
    if (!found_.goal.asked[static_cast<std::size_t>(Cost::lookup)]) return;
    double most_seconds = std::min(again_share * whole_time(), again_share_left * left());
    while (!stopped()) {
        std::vector<Point> points;
        for (const Point& point : to_time_again(found_.families, families_, incumbents_)) {
            const double seconds = lab_.effort(point) + seconds_again;
            if (points.size() == most_again || seconds > most_seconds) continue;
            most_seconds -= seconds;
            points.push_back(point);
        }
        if (std::all_of(points.begin(), points.end(), [&](const Point& point) { return is_timed_again(point); }))
            return;
        if (!time_in_turns(points)) return;
    }
}

bool Search::is_timed_again(const Point& point) const {
    const std::span<const Record> records = families_[point.family].records();
    return std::any_of(records.begin(), records.end(),
                       [&](const Record& record) { return record.timed_again && record.step == point.step; });
}

// Returns false if none could be timed.
bool Search::time_in_turns(const std::vector<Point>& points) {
    report(Stage::confirming, points.size());
    const std::vector<std::optional<double>> times = lab_.time_again(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!times[i]) continue;
        families_[points[i].family].time_again(points[i], *times[i]);
        for (Measured& measured : found_.measured)
            if (measured.point == points[i]) measured.trial.cost[static_cast<std::size_t>(Cost::lookup)] = *times[i];
    }
    update_all();
    return std::any_of(times.begin(), times.end(), [](const std::optional<double>& time) { return time.has_value(); });
}

bool Search::is_best(const Point& point) const {
    for (std::size_t k = 0; k < costs; ++k)
        if (found_.goal.asked[k] && incumbents_.best[k] == point) return true;
    return false;
}

bool Search::is_confirmed(const Point& point) const {
    return std::any_of(found_.confirmed.begin(), found_.confirmed.end(),
                       [&](const Answered& answered) { return answered.point == point; });
}

// The best points, for each of them one that is safe, and those of the others that take a small share of these seconds.
std::vector<Point> Search::affordable(const ToConfirm& wanted, double seconds) {
    std::vector<Point> kept;
    std::copy_if(wanted.points.begin(), wanted.points.end(), std::back_inserter(kept),
                 [&](const Point& point) { return is_best(point); });
    // Without an answer among the maps, one without a map is due.
    if (kept.empty() && !wanted.points.empty()) kept.push_back(wanted.points.front());
    const auto is_kept = [&](const Point& point) { return std::find(kept.begin(), kept.end(), point) != kept.end(); };
    for (const std::vector<Point>& safe : wanted.safe) {
        if (std::any_of(safe.begin(), safe.end(), is_kept)) continue;
        const auto first = std::find_if(safe.begin(), safe.end(), [&](const Point& point) {
            return lab_.confirm_effort(point, kept) <= safe_share * seconds;
        });
        if (first != safe.end()) kept.push_back(*first);
    }
    for (const Point& point : wanted.points) {
        if (is_kept(point)) continue;
        if (lab_.confirm_effort(point, kept) <= other_share * seconds)
            kept.push_back(point);
        else if (found_.end == End::complete)
            found_.end = End::budget;
    }
    return kept;
}

void Search::confirm() {
    double seconds_a_point = 0.0;
    for (int round = 0; round < confirm_rounds; ++round) {
        // The first round is due even if the budget is spent: without it there is no answer.
        if (round == 0 ? cancelled() : stopped()) return;
        const double round_share = round == 0 ? first_round_share : 1.0;
        const std::vector<Point> points =
            affordable(to_confirm(found_.families, families_, found_.goal.asked, incumbents_), round_share * left());
        if (std::all_of(points.begin(), points.end(), [&](const Point& point) { return is_confirmed(point); })) return;
        if (static_cast<double>(points.size()) * seconds_a_point > left()) {
            found_.end = End::budget;
            return;
        }
        report(Stage::confirming, points.size());
        const double before = left();
        const std::vector<Confirmed> answers =
            lab_.confirm(points, {found_.goal.error, found_.goal.asked[static_cast<std::size_t>(Cost::build)],
                                  round_share * std::max(before, 0.0)});
        if (std::isfinite(before)) seconds_a_point = (before - left()) / static_cast<double>(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            families_[points[i].family].confirm(points[i], answers[i]);
            std::erase_if(found_.confirmed, [&](const Answered& a) { return a.point == points[i]; });
            found_.confirmed.push_back({points[i], answers[i]});
        }
        wanted_.trial_error = found_.goal.error / growth(found_);
        update_all();
        go_on();
    }
}

// Exploring after a confirmation. It took less time than was left to it, as a rule: then climbs that seemed to take too
// long go on too, and only what is then left out says that the budget ended.
void Search::go_on() {
    if (found_.end == End::budget) found_.end = End::complete;
    refine();
    if (std::isfinite(left())) {
        climb();
        refine();
    }
    try_variants();
    time_again();
}

// Why the search ended with time left.
void Search::note_next() {
    const double skipped = std::min(skipped_climb_, skipped_point_), seconds = skipped + reserve_;
    if (found_.end == End::budget && std::isfinite(skipped) && left() > 0.0 && seconds > left())
        found_.next = {seconds, left()};
}

Exploration Search::run() {
    climb();
    probe();
    refine();
    try_variants();
    time_again();
    refine();
    confirm();
    note_next();
    return std::move(found_);
}

Exploration explore(Lab& lab, const Goal& goal, const Hooks& hooks) {
    using base::Error;
    using base::ErrorCode;
    if (!(goal.error > 0.0) || !std::isfinite(goal.error))
        throw Error(ErrorCode::usage, "--error", "the error asked for must be above 0");
    if (!(goal.budget > 0.0)) throw Error(ErrorCode::usage, "--budget", "the budget must be above 0 seconds");
    if (std::none_of(goal.asked.begin(), goal.asked.end(), [](bool asked) { return asked; }))
        throw Error(ErrorCode::usage, "--cheapest", "ask for the least lookup time, bytes or build time");
    const std::span<const Family> families = lab.families();
    if (!goal.asked[static_cast<std::size_t>(Cost::lookup)] &&
        std::all_of(families.begin(), families.end(), [](const Family& family) { return family.mapless; }))
        throw Error(ErrorCode::usage, "--cheapest",
                    "a technique that stores no map holds no bytes and builds nothing; ask for lookup");
    return Search(lab, goal, hooks).run();
}

}  // namespace shadowbench::recommend
