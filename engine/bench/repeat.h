// How often timed passes are repeated.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

namespace shadowbench::bench {

// At least `least` rounds and at most `most`; between the two, until all intervals are narrow enough, or until another
// round as long as the last would make those beyond the least ones take `seconds` or more.
//
// A round passes over all techniques, also over those whose intervals are narrow already. So all techniques are
// measured in the same rounds, a machine that changes its speed changes it for all, and their ratios stay fair; and a
// technique does not stop at a lucky moment of its own. Builds and lookups are two parts of a round, which are never
// compared with each other: each is left out of further rounds once all its own intervals are narrow.
//
// Intervals are looked at after 7, 11, 15, 19, ... rounds only. To stop because an interval is narrow makes it narrow
// too often: intervals hold the median less often than a fixed number of rounds lets them. At these numbers
// metrics::order_interval() holds it in 96.5 % of the cases or more, and 93 % remain after stopping: see the tests.
struct RepeatRule {
    std::size_t least = 0, most = 0;
    double seconds = 0.0;
};

// Whether another round follows `done` rounds. With it, those beyond the least ones would take `seconds_with_next`.
// `all_narrow` is asked only when it matters.
bool goes_on(const RepeatRule& rule, std::size_t done, double seconds_with_next, const std::function<bool()>& all_narrow);

// A part of every round, until it ends by itself.
struct RoundPart {
    std::function<void(std::size_t round)> pass;
    std::function<bool()> all_narrow;
};

// Makes the rounds 0, 1, ... of the rule, each of all parts, in order, that have not ended.
void repeat(const RepeatRule& rule, std::span<const RoundPart> parts);
// The same with one part.
void repeat(const RepeatRule& rule, const std::function<void(std::size_t round)>& round,
            const std::function<bool()>& all_narrow);

}  // namespace shadowbench::bench
