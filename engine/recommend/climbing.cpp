// The first step of a search: every family climbs along one line, and a faithful one looks to both sides of it.
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "recommend/ladder.h"
#include "recommend/search_steps.h"

namespace shadowbench::recommend {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A climb ends if its error would stay too large even if the rungs left lowered it so many times faster.
constexpr double faster = 2.0;
// Or if others were built from the light rays of the next rung, and the model gives it a chance below this.
constexpr double climbing_chance = 0.02;
// Faithful families climb before others that take up to this times less effort: what light rays leave is then known.
constexpr double faithful_first = 2.0;
// A probe beside the climbs, and a rung once something answers, may take this share of the time left.
constexpr double probe_share = 0.1;

}  // namespace

// Whether this point, and all that are more accurate, certainly cost more than what is known, in every cost asked.
bool Search::too_dear(std::size_t family, std::size_t index) const {
    for (std::size_t k = 0; k < costs; ++k)
        if (found_.goal.asked[k] &&
            families_[family].least(index, static_cast<Cost>(k)) < incumbents_.limit(found_.families[family], k).cost)
            return false;
    return true;
}

// Whether the scout errs so much with these light rays, or more of them, that a climb may begin above. The scout sees
// only the rays inside a footprint, so other filters may err less; refining may come back to such rays.
bool Search::too_few_rays(std::size_t family, const Point& point) const {
    if (!found_.scout || family == *found_.scout ||
        !same_light_rays(found_.families[family], found_.families[*found_.scout]))
        return false;
    const std::span<const Record> records = families_[*found_.scout].records();
    return std::any_of(records.begin(), records.end(), [&](const Record& record) {
        const Floor floor{record.step[0], record.step[1], record.error};
        return record.failed.empty() && floor.rules_out(point.step, wanted_.error);
    });
}

// The next rung of a family's climb; nothing if it is done. Rungs that are ruled out, or have too few rays, are left
// out. Of families that answer alike the first climbs, and tells the others their errors.
std::optional<std::size_t> Search::next_climb(std::size_t family) const {
    const Knowledge& known = families_[family];
    const std::span<const Record> records = known.records();
    const Climb& climb = climbs_[family];
    if (known.left_out() || found_.families[family].answers_as) return {};
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
    // What is left after confirming is for whatever fits.
    const double share = found_.confirmed.empty() ? probe_share : 1.0;
    skipped_climb_ = infinity;
    while (!exploring_over()) {
        std::optional<std::size_t> chosen;
        double least = infinity;
        std::size_t climbing = 0;
        double skipped = infinity;
        for (std::size_t i = 0; i < families_.size(); ++i) {
            const std::optional<std::size_t> rung = next_climb(i);
            if (!rung) continue;
            ++climbing;
            const double seconds = lab_.effort(climbs_[i].rungs[*rung]);
            if (!fits(seconds) || (answered() && seconds > share * left_to_explore())) {
                skipped = std::min(skipped, seconds);
                continue;
            }
            const double effort = seconds * (found_.families[i].faithful ? 1.0 : faithful_first);
            if (chosen && found_.scout == chosen) continue;
            if (effort >= least && found_.scout != i) continue;
            least = effort;
            chosen = i;
        }
        if (!chosen) {
            skipped_climb_ = skipped;
            if (std::isfinite(skipped) && found_.end == End::complete) found_.end = End::budget;
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

// Of the faithful families that are good enough, the point with the fewest light rays; if none is, that with the most.
// Of several with the same light rays, the one that errs least.
std::optional<Point> Search::best_witness() const {
    std::optional<Point> best;
    std::tuple<bool, double, double> least{true, infinity, infinity};
    for (std::size_t f = 0; f < families_.size(); ++f) {
        const Family& family = found_.families[f];
        if (!family.faithful) continue;
        for (const Record& record : families_[f].records()) {
            if (!record.failed.empty()) continue;
            const bool missed = !families_[f].acceptable(record);
            const double rays = static_cast<double>(record.step[0]) / family.axes[0].stride +
                                static_cast<double>(record.step[1]) / family.axes[1].stride;
            const std::tuple order{missed, missed ? -rays : rays, record.error};
            if (best && order >= least) continue;
            best = Point{f, record.step};
            least = order;
        }
    }
    return best;
}

// Climbs go along one line, all axes together: what each axis does is not known yet.
void Search::probe() {
    probe_light_rays();
    probe_own_axes();
}

// A family with several axes of its own that climbed to a good enough setting looks at each of them: perhaps its
// cheapest step suffices there.
void Search::probe_own_axes() {
    for (std::size_t f = 0; f < families_.size(); ++f) {
        const std::size_t climbed = climbs_[f].measured;
        if (found_.families[f].axes.size() < 4 || climbed == 0) continue;
        const Record reached = families_[f].records()[climbed - 1];
        if (!families_[f].acceptable(reached)) continue;
        for (std::size_t axis = 2; axis < reached.step.size(); ++axis) {
            Point point{f, reached.step};
            point.step[axis] = 0;
            probe_at(point);
        }
    }
}

// Measures a point that may be good enough, if it takes little time.
void Search::probe_at(const Point& point) {
    const std::size_t index = families_[point.family].lattice().index(point.step);
    if (families_[point.family].measured(index) || families_[point.family].ruled_out(index)) return;
    if (lab_.effort(point) > probe_share * left_to_explore() || exploring_over()) return;
    report(Stage::refining, 1);
    measure(point);
}

// A faithful family looks to both sides of the climbs, at about as many light rays: coarser maps with more samples, and
// finer ones with fewer. What it finds there tells all families which light rays may suffice.
void Search::probe_light_rays() {
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
            probe_at(point);
        }
}

}  // namespace shadowbench::recommend
