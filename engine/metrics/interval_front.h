// Pareto fronts of choices whose costs and errors are uncertain.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "metrics/statistics.h"

namespace shadowbench::metrics {

enum class OnFront { no, perhaps, certainly };
const char* to_string(OnFront on);

// An interval for (value of choice a) - (value of choice b), where smaller is better; called for a < b only. {0, 0}
// says that the two are equal. All intervals of one front should hold together: see tail_of_front().
using Difference = std::function<Interval(std::size_t a, std::size_t b)>;

// Choice A certainly beats B if it is certainly not worse in cost and in error (no positive value in either interval),
// and certainly better in one of them (only negative values).
// A may beat B unless it is certainly worse in cost or in error, or certainly equal in both.
// A choice that another certainly beats is on the front: no. One that no other may beat: certainly. Else: perhaps.
//
// If the intervals all hold, so do all marks other than perhaps. If they all have no width, none is perhaps, and the
// marks are those of pareto_front(). O(n^2).
std::vector<OnFront> front_of_intervals(std::size_t choices, const Difference& cost, const Difference& error);

// The probability that may lie beyond one end of one interval, so that all 2 x choices (choices - 1) / 2 intervals of a
// front hold together with this confidence. Bonferroni's inequality: it holds however the intervals depend on each
// other, and intervals of pairs depend strongly.
double tail_of_front(std::size_t choices, double confidence);

}  // namespace shadowbench::metrics
