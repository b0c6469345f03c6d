// The best settings measured so far, and which of them to confirm.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "recommend/exploration.h"
#include "recommend/knowledge.h"

namespace shadowbench::recommend {

// Per cost the least of all acceptable settings with a map, and the least of another technique. Settings without a map
// compete among themselves, and only for the least lookup time.
struct Incumbents {
    struct Limit {
        double cost;  // a point must cost less to matter; infinite if nothing is acceptable yet
        bool leads;   // the technique has the least cost, or nothing has
    };

    std::array<std::optional<Point>, costs> best;
    std::array<std::string, costs> technique;  // of the best
    std::array<double, costs> least;           // infinite if there is none
    std::array<double, costs> second;          // of another technique
    double without_map = std::numeric_limits<double>::infinity();  // the least lookup time

    bool operator==(const Incumbents&) const = default;

    Limit limit(const Family& family, std::size_t cost) const {
        if (family.mapless) return {static_cast<Cost>(cost) == Cost::lookup ? without_map : 0.0, true};
        const std::string& of = family.technique;
        if (!best[cost]) return {std::numeric_limits<double>::infinity(), true};
        return of == technique[cost] ? Limit{least[cost], true} : Limit{second[cost], false};
    }
};
Incumbents find_incumbents(std::span<const Family> families, std::span<const Knowledge> known);

struct ToConfirm {
    // What an answer needs confirmed and is not: per cost asked the best, those within noise of it, and the runner-up of
    // another technique. If there are any and times matter, the best of the confirmed points come along, so that their
    // times are measured together. Empty if all is confirmed.
    std::vector<Point> points;
    // Per cost asked of which nothing is confirmed: points of the leading technique that err clearly less than wanted,
    // cheapest first. The best may turn out to err too much; one of each list stands in for it.
    std::vector<std::vector<Point>> safe;
};
ToConfirm to_confirm(std::span<const Family> families, std::span<const Knowledge> known,
                     const std::array<bool, costs>& asked, const Incumbents& incumbents);

// The settings whose lookups trials hardly tell from the fastest acceptable one's, with it, fastest first; confirmed ones
// are left out. Empty if none of them is left to be timed again.
std::vector<Point> to_time_again(std::span<const Family> families, std::span<const Knowledge> known,
                                 const Incumbents& incumbents);

// How much the upper ends of confirmed errors exceed the errors of the trials: the median of the ratios, at least 1; 1 if
// there are few ratios. If time is limited there may be no other round of confirming: then every ratio counts, and it is
// at least what is usual.
double growth(const Exploration& found);

}  // namespace shadowbench::recommend
