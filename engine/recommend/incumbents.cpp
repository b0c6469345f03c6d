#include "recommend/incumbents.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "metrics/statistics.h"

namespace shadowbench::recommend {
namespace {

// Points that cost at most this times the least are confirmed with it.
constexpr std::array<double, costs> close{1.1, 1.02, 1.1};
// Points that err by at most this times the error wanted in a trial may turn out to err less.
constexpr double doubtful = 1.06;
// Until a setting of the leading technique is confirmed, one that errs by at most this is confirmed too: those closer to
// the error wanted often turn out to err more, and the budget may end before another round.
constexpr double safe = 0.95;
// How many are confirmed in one round. Trials rank bytes well, and times only roughly.
constexpr std::array<std::size_t, costs> most_leaders{3, 1, 3}, most_followers{2, 1, 2};
constexpr std::size_t most_doubtful = 1;
// Lookups are timed again whose trials took at most this times the least: trials of a quiet machine are off by up to a
// tenth, and a cache that another process used makes one slower still.
constexpr double hardly_told = 1.3;
constexpr double usual_growth = 1.02;
constexpr std::size_t enough_ratios = 3;

struct Candidate {
    Point point;
    double cost;
    double excess;
    bool confirmed;
};

// The unconfirmed points that may be the cheapest: those that seem acceptable, cheapest first, and those in doubt, least
// error first. If there are any, the cheapest confirmed one comes with them. Returns those that are safe, cheapest
// first, unless one is confirmed.
std::vector<Point> select(const std::vector<Candidate>& candidates, std::size_t k, std::size_t most,
                          std::vector<Point>& chosen) {
    std::vector<Candidate> seem, doubt;
    const Candidate* sure = nullptr;
    for (const Candidate& candidate : candidates) {
        if (!candidate.confirmed) (candidate.excess <= 1.0 ? seem : doubt).push_back(candidate);
        if (candidate.confirmed && candidate.excess <= 1.0 && (!sure || candidate.cost < sure->cost)) sure = &candidate;
    }
    std::stable_sort(seem.begin(), seem.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
    std::stable_sort(doubt.begin(), doubt.end(), [](const auto& a, const auto& b) { return a.excess < b.excess; });
    const double least = seem.empty() ? std::numeric_limits<double>::infinity() : seem.front().cost;
    const std::size_t before = chosen.size();
    for (const Candidate& candidate : seem)
        if (chosen.size() - before < most && (sure ? candidate.cost < sure->cost : candidate.cost <= least * close[k]))
            chosen.push_back(candidate.point);
    const std::size_t between = chosen.size();
    for (const Candidate& candidate : doubt)
        if (chosen.size() - between < most_doubtful && candidate.cost < (sure ? std::min(sure->cost, least) : least))
            chosen.push_back(candidate.point);
    if (sure && chosen.size() > before) chosen.push_back(sure->point);
    std::vector<Point> clear;
    for (const Candidate& candidate : seem)
        if (!sure && candidate.excess <= safe) clear.push_back(candidate.point);
    return clear;
}

}  // namespace

Incumbents find_incumbents(std::span<const Family> families, std::span<const Knowledge> known) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Incumbents found;
    found.least.fill(infinity);
    found.second.fill(infinity);
    for (std::size_t f = 0; f < known.size(); ++f)
        for (const Record& record : known[f].records())
            if (families[f].mapless && known[f].acceptable(record))
                found.without_map = std::min(found.without_map, record.cost[static_cast<std::size_t>(Cost::lookup)]);
    for (std::size_t k = 0; k < costs; ++k) {
        for (std::size_t f = 0; f < known.size(); ++f)
            for (const Record& record : known[f].records())
                if (!families[f].mapless && known[f].acceptable(record) && record.cost[k] < found.least[k]) {
                    found.least[k] = record.cost[k];
                    found.best[k] = Point{f, record.step};
                    found.technique[k] = families[f].technique;
                }
        for (std::size_t f = 0; f < known.size(); ++f)
            if (found.best[k] && !families[f].mapless && families[f].technique != found.technique[k])
                for (const Record& record : known[f].records())
                    if (known[f].acceptable(record)) found.second[k] = std::min(found.second[k], record.cost[k]);
    }
    return found;
}

ToConfirm to_confirm(std::span<const Family> families, std::span<const Knowledge> known,
                     const std::array<bool, costs>& asked, const Incumbents& incumbents) {
    std::vector<Point> chosen;
    ToConfirm result;
    for (std::size_t k = 0; k < costs; ++k) {
        if (!asked[k]) continue;
        std::vector<Candidate> leaders, followers, without_map;
        for (std::size_t f = 0; f < known.size(); ++f)
            for (const Record& record : known[f].records()) {
                const double excess = known[f].excess(record);
                if (!(excess <= (record.confirmed ? 1.0 : doubtful))) continue;
                auto& list = families[f].mapless                                  ? without_map
                             : families[f].technique == incumbents.technique[k] ? leaders
                                                                                  : followers;
                list.push_back({Point{f, record.step}, record.cost[k], excess, record.confirmed});
            }
        if (std::vector<Point> clear = select(leaders, k, most_leaders[k], chosen); !clear.empty())
            result.safe.push_back(std::move(clear));
        select(followers, k, most_followers[k], chosen);
        if (static_cast<Cost>(k) == Cost::lookup) select(without_map, k, 1, chosen);
    }
    std::vector<Point>& unique = result.points;
    for (const Point& point : chosen)
        if (std::find(unique.begin(), unique.end(), point) == unique.end()) unique.push_back(point);
    return result;
}

std::vector<Point> to_time_again(std::span<const Family> families, std::span<const Knowledge> known,
                                 const Incumbents& incumbents) {
    constexpr std::size_t k = static_cast<std::size_t>(Cost::lookup);
    std::vector<Candidate> alike;
    bool all_timed = true;
    for (std::size_t f = 0; f < known.size(); ++f)
        for (const Record& record : known[f].records()) {
            if (families[f].mapless || record.confirmed || !known[f].acceptable(record)) continue;
            if (record.cost[k] > hardly_told * incumbents.least[k]) continue;
            alike.push_back({Point{f, record.step}, record.cost[k], known[f].excess(record), false});
            all_timed = all_timed && record.timed_again;
        }
    std::stable_sort(alike.begin(), alike.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
    std::vector<Point> points;
    if (!all_timed)
        for (Candidate& candidate : alike) points.push_back(std::move(candidate.point));
    return points;
}

double growth(const Exploration& found) {
    const bool limited = std::isfinite(found.goal.budget);
    const std::size_t enough = limited ? 1 : enough_ratios;
    const double least = limited ? usual_growth : 1.0;
    std::vector<double> ratios;
    for (const Answered& answered : found.confirmed)
        for (const Measured& measured : found.measured)
            if (measured.point == answered.point && answered.confirmed.failed.empty() && measured.trial.error > 0.0)
                ratios.push_back(answered.confirmed.error.high / measured.trial.error);
    return ratios.size() < enough ? least : std::max(least, metrics::median(ratios));
}

}  // namespace shadowbench::recommend
