#include "recommend/incumbents.h"

#include <algorithm>

#include "metrics/statistics.h"

namespace shadowbench::recommend {
namespace {

// Points that cost at most this times the least are confirmed with it.
constexpr std::array<double, costs> close{1.1, 1.02, 1.1};
constexpr std::size_t most_leaders = 4, most_followers = 2;  // confirmed in one round, per cost

struct Candidate {
    Point point;
    double cost;
    bool confirmed;
};

// The unconfirmed points that may be the cheapest, cheapest first; and, if there are any, the cheapest confirmed one.
void select(std::vector<Candidate> candidates, std::size_t k, std::size_t most, std::vector<Point>& chosen) {
    if (candidates.empty()) return;
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
    const auto sure =
        std::find_if(candidates.begin(), candidates.end(), [](const Candidate& c) { return c.confirmed; });
    const double limit = sure == candidates.end() ? candidates.front().cost * close[k] : sure->cost;
    std::size_t taken = 0;
    for (const Candidate& candidate : candidates) {
        if (candidate.confirmed || taken == most) continue;
        if (sure == candidates.end() ? candidate.cost > limit : candidate.cost >= limit) continue;
        chosen.push_back(candidate.point);
        ++taken;
    }
    if (taken > 0 && sure != candidates.end()) chosen.push_back(sure->point);
}

}  // namespace

Incumbents find_incumbents(std::span<const Family> families, std::span<const Knowledge> known) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Incumbents found;
    found.least.fill(infinity);
    found.second.fill(infinity);
    for (std::size_t k = 0; k < costs; ++k) {
        for (std::size_t f = 0; f < known.size(); ++f)
            for (const Record& record : known[f].records())
                if (known[f].acceptable(record) && record.cost[k] < found.least[k]) {
                    found.least[k] = record.cost[k];
                    found.best[k] = Point{f, record.step};
                    found.technique[k] = families[f].technique;
                }
        for (std::size_t f = 0; f < known.size(); ++f)
            if (found.best[k] && families[f].technique != found.technique[k])
                for (const Record& record : known[f].records())
                    if (known[f].acceptable(record)) found.second[k] = std::min(found.second[k], record.cost[k]);
    }
    return found;
}

std::vector<Point> to_confirm(std::span<const Family> families, std::span<const Knowledge> known,
                              const std::array<bool, costs>& asked, const Incumbents& incumbents) {
    std::vector<Point> chosen;
    for (std::size_t k = 0; k < costs; ++k) {
        if (!asked[k] || !incumbents.best[k]) continue;
        std::vector<Candidate> leaders, followers;
        for (std::size_t f = 0; f < known.size(); ++f)
            for (const Record& record : known[f].records()) {
                if (!known[f].acceptable(record)) continue;
                auto& list = families[f].technique == incumbents.technique[k] ? leaders : followers;
                list.push_back({Point{f, record.step}, record.cost[k], record.confirmed});
            }
        select(std::move(leaders), k, most_leaders, chosen);
        select(std::move(followers), k, most_followers, chosen);
    }
    std::vector<Point> unique;
    for (const Point& point : chosen)
        if (std::find(unique.begin(), unique.end(), point) == unique.end()) unique.push_back(point);
    return unique;
}

double growth(const Exploration& found) {
    std::vector<double> ratios;
    for (const Answered& answered : found.confirmed)
        for (const Measured& measured : found.measured)
            if (measured.point == answered.point && answered.confirmed.failed.empty() && measured.trial.error > 0.0)
                ratios.push_back(answered.confirmed.error.high / measured.trial.error);
    return ratios.size() < 3 ? 1.0 : std::max(1.0, metrics::median(ratios));
}

}  // namespace shadowbench::recommend
