// Whether the machine was quiet while a run's lookups were timed, judged by their floors.
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
// A run is unsettled if, for some light,
//   - a floor of one cell in one order spreads by more than `floor_limit`: the interquartile range of its repetitions
//     over their median;
//   - or the pace spreads by more than `pace_limit`. The pace of a repetition is the median, over all floors, of its
//     time over that floor's median. It shows a machine that changed during a part of the run and slowed all cells
//     alike. It is judged if there are at least `least_floors` floors: the median of fewer is not steady.
// Quartiles ignore a few late interrupts, as medians do. A floor of fewer than `least_repetitions` is not judged.
//
// The limits follow from ordinary noise on shared virtual machines without other work: a pass of 2 to 50 ms varies by 5
// to 10 % (standard deviation), of which the slow part, shared by all cells, is 5 %. The quartiles of normal noise are
// 1.35 standard deviations apart: 7 to 14 % for a floor, 7 % for the pace. The limits are about twice that. Beyond them
// the median of nine passes is off by 8 % or more (1.25 x 19 % / 3), too much for rankings and fronts of medians:
// neighbours on a front are often as close.
inline constexpr double floor_limit = 0.25, pace_limit = 0.15;
inline constexpr std::size_t least_repetitions = 5, least_floors = 6;

struct FloorSpread {
    std::string cell;        // its title
    const char* order = "";  // "image" or "random"
    double spread = 0.0;
};

struct Settling {
    std::size_t floors = 0;             // number of floors judged; 0: nothing is known
    std::size_t unjudged = 0;           // number of floors with too few repetitions
    std::vector<FloorSpread> unsteady;  // those beyond the limit, the widest first
    std::optional<double> pace;         // its spread; absent if it was not judged

    bool settled() const { return unsteady.empty() && !(pace && *pace > pace_limit); }
};
Settling settling(const LightResult& light);

// The reasons in words: "3 of 14 floors spread by more than 25 % (...)"; empty if settled, or if nothing is known.
std::string unsettled_text(const Settling& settling);

// Whether all lights of the run are settled; absent if nothing is known of any.
std::optional<bool> settled(const Result& result);

}  // namespace shadowbench::results
