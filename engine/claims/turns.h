// Things that are timed in turn: what the machine does to one of them it does to all, so the ratios of their times are
// steadier than the times.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "bench/repeat.h"
#include "claims/value.h"

namespace shadowbench::claims {

// Rounds go on until half the interval of every ratio that a claim judges is at most this share of the ratio. Limits of
// one rule for times are a factor of 1.25 apart or more: see rules.cpp. So a claim stays undecided only if its ratio is
// at a limit.
inline constexpr double ratio_goal = 0.05;

// Of lookups, a round of which takes a fraction of a second, and of builds, a round of which takes seconds. After that
// many looks at them, intervals still hold the median as often as bench/repeat.h says: see its tests. The seconds keep
// the timing of all papers within a few minutes.
inline constexpr bench::RepeatRule lookup_rounds{15, 39, 10.0}, build_rounds{7, 31, 10.0};
// Of what no single ratio tells when to stop, or of a ratio that is only asked to be above or below 1.
inline constexpr bench::RepeatRule fixed_rounds{31, 31, 0.0};

// Two of the things, by their places, whose ratio a claim judges.
struct Compared {
    std::size_t one, other;
};

struct Turns {
    std::vector<std::vector<double>> times;  // [thing][round]

    Value time(std::size_t thing) const;                    // the median over rounds
    Value ratio(std::size_t one, std::size_t other) const;  // the median over rounds of each round's ratio
    // The largest ratio of one of these things, at least two, to one that stands before it: how much the time grows in
    // this order; below 1 if it only falls. Each end of its interval is the largest of all these ratios' ends.
    Value growth(std::span<const std::size_t> of) const;
};

// Each thing does its work once and returns the time that it took. Every other round goes backwards, so that no thing
// always follows the same one.
Turns take_turns(std::span<const std::function<double()>> things, std::span<const Compared> compared,
                 const bench::RepeatRule& rule);

}  // namespace shadowbench::claims
