// Whether a run's times are settled: the machine was quiet while they were measured, and their intervals are narrow.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "results/result.h"

namespace shadowbench::results {

// A floor reads the same lines of the same map in every repetition, so its times differ only by the machine. Floors are
// compared within a run, never with those of another run.
//
// The machine was disturbed if, for some light,
//   - a floor of one cell in one order spreads by more than `floor_limit`: the interquartile range of its repetitions
//     over their median;
//   - or the pace spreads by more than `pace_limit`. The pace of a repetition is the median, over all floors, of its
//     time over that floor's median. It shows a machine that changed during a part of the run and slowed all cells
//     alike. It is judged if there are at least `least_floors` floors: the median of fewer is not steady;
//   - or the pace drifted by more than `drift_limit` from the first repetition to the last: see metrics::drift();
//   - or more than `interrupted_limit` of the timed passes of its builds, or of its lookups, were interrupted: the
//     scheduler gave the processor to another thread while they ran;
//   - or the host of a virtual machine took more than `steal_limit` of the seconds of timing, summed over all
//     processors.
// A time is uncertain if it has at least `least_repetitions` and its interval is wider than the goal of the scenario:
// see is_narrow(). A run is unsettled if the machine was disturbed or a time is uncertain.
//
// Quartiles ignore a few late interrupts, as medians do. A floor of fewer than `least_repetitions` is not judged.
//
// The limits follow from ordinary noise on shared virtual machines without other work: a pass of 2 to 50 ms varies by 5
// to 10 % (standard deviation), of which the slow part, shared by all cells, is 5 %. The quartiles of normal noise are
// 1.35 standard deviations apart: 7 to 14 % for a floor, 7 % for the pace. The limits are about twice that. Beyond them
// the median of nine passes is off by 8 % or more (1.25 x 19 % / 3), too much for rankings and fronts of medians:
// neighbours on a front are often as close. A pace that drifts by 15 % puts the median 8 % off from both ends.
//
// An interrupted pass is late by a share of itself that nobody knows. If a fifth of the passes are late, the median is
// the 62 % quantile of the others: 0.3 standard deviations too high, up to half of the half width of its interval after
// 9 to 31 repetitions. With more, times are off by as much as their intervals admit. The host takes a processor for a
// millisecond or more; at 2 % of the time, slices of 1 ms reach a fifth of the passes of 10 ms, which is the same harm.
inline constexpr double floor_limit = 0.25, pace_limit = 0.15, drift_limit = 0.15;
inline constexpr double interrupted_limit = 0.20, steal_limit = 0.02;
inline constexpr std::size_t least_repetitions = 5, least_floors = 6;

struct FloorSpread {
    std::string cell;        // its title
    const char* order = "";  // "image" or "random"
    double spread = 0.0;
};

// Whether half the width of the interval is at most `goal` times the median, or at most 0.005: less does not show in a
// table, and the build of a technique that stores nothing takes no longer (in ms).
bool is_narrow(const Sample& sample, double goal);

// Whether a time of this light is certain enough; absent if the goal is not known, or with fewer than
// `least_repetitions`.
std::optional<bool> is_settled(const Sample& sample, const LightResult& light);

struct UncertainTime {
    std::string cell;         // its title
    const char* what = "";    // "build", "image order" or "random order"
    double half_width = 0.0;  // of its interval, over the median
};

struct Settling {
    std::size_t floors = 0;             // number of floors judged
    std::size_t unjudged = 0;           // number of floors with too few repetitions
    std::vector<FloorSpread> unsteady;  // those beyond the limit, the widest first
    std::optional<double> pace;         // its spread; absent if it was not judged
    std::optional<double> drift;        // of the pace, last over first, less 1; absent if it did not drift that far
    std::optional<double> builds_interrupted, lookups_interrupted;  // shares of the passes; absent if not counted
    std::optional<double> steal;                                    // over the seconds of timing; absent if unknown
    std::size_t times = 0;                                          // number of times judged by their interval
    std::vector<UncertainTime> uncertain;                           // the widest first
    double goal = 0.0;                                              // of their intervals

    bool known() const { return floors > 0 || times > 0; }
    bool disturbed() const;
    bool settled() const { return !disturbed() && uncertain.empty(); }
};
// Interruptions and steal are judged only where a floor or a time is.
Settling settling(const LightResult& light);

// What disturbed the machine, in words: "3 of 14 floors spread by more than 25 % (...)"; empty if nothing did, or if
// nothing is known.
std::string disturbance_text(const Settling& settling);

// That, and which times are uncertain; empty if settled, or if nothing is known.
std::string unsettled_text(const Settling& settling);

// Whether all lights of the run are settled; absent if nothing is known of any.
std::optional<bool> settled(const Result& result);

// One line at the end of a run of these scenarios: which were unsettled, and why; at most three lights are named. Empty
// if all are settled, or if nothing is known.
std::string unsettled_line(const std::vector<const Result*>& results);

}  // namespace shadowbench::results
