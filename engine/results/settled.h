// Whether the machine was quiet while a run's lookups were timed: what their floors say of it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "results/result.h"

namespace shadowbench::results {

// A floor reads the same lines of the same map in every repetition: its times differ by the machine alone. They are
// compared within a run, never with those of another.
//
// A run is unsettled where, in some light,
//   a floor of one cell in one order spreads by more than `floor_limit`: the difference of the quartiles of its
//     repetitions over their median;
//   or the pace does, by more than `pace_limit`: the pace of a repetition is the median, over all floors, of its time
//     over that floor's median. Then a few cells are no worse than others, but the machine was another in a part of the
//     run. Asked where there are at least `least_floors` floors: of fewer the median is not steady.
// Quartiles, so that a few late interrupts, which medians pass over, do not count. Fewer than `least_repetitions` tell
// nothing.
//
// The limits, from what is ordinary on shared virtual machines without other work: a pass of 2 to 50 ms varies by 5 to
// 10 % (standard deviation), the slow part of it, which all cells share, by 5 %. Of normal noise the quartiles are 1.35
// standard deviations apart: 7 to 14 % of a floor, 7 % of the pace. The limits are about twice that. Beyond them the
// median of nine passes is off by 8 % and more (1.25 x 19 % / 3), which is past what rankings and fronts of medians can
// bear: neighbours on a front are often as near.
inline constexpr double floor_limit = 0.25, pace_limit = 0.15;
inline constexpr std::size_t least_repetitions = 5, least_floors = 6;

struct FloorSpread {
    std::string cell;        // its title
    const char* order = "";  // "image" or "random"
    double spread = 0.0;
};

struct Settling {
    std::size_t floors = 0;             // that were judged; 0: nothing is known
    std::vector<FloorSpread> unsteady;  // beyond the limit, the widest first
    std::optional<double> pace;         // how far it spreads; nothing where it was not asked for

    bool settled() const { return unsteady.empty() && !(pace && *pace > pace_limit); }
};
Settling settling(const LightResult& light);

// In words: "3 of 14 floors spread by more than 25 % (...)"; empty where it is settled, or nothing is known.
std::string unsettled_text(const Settling& settling);

// Of all lights of the run; nothing where of none is anything known.
std::optional<bool> settled(const Result& result);

}  // namespace shadowbench::results
