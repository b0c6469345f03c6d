// Slow change along a series of results, which no comparison of neighbours shows.
#pragma once

#include <optional>
#include <span>

namespace shadowbench::metrics {

// Kendall 1938, Mann 1945: the probability that values in an order without a trend rise or fall along it at least as
// clearly as these (two-sided). Exact up to 60 values that all differ; else the normal approximation, corrected for
// ties and continuity. 1 for fewer than two values.
double trend_p(std::span<const double> values);

// A straight line through (0, values[0]), (1, values[1]), ...: the median of all pairwise slopes (Theil 1950, Sen
// 1968), and the median of where lines of that slope through each value start. One value far off does not move it.
struct Line {
    double first, last;  // at the first and the last value
};
Line robust_line(std::span<const double> values);

// The line, where the values follow it: trend_p() at or under 0.01, and the line changes by more than the factor
// 1 + least, up or down (of values of one sign; of others by any amount). Fewer than five values show none.
std::optional<Line> drift(std::span<const double> values, double least);

}  // namespace shadowbench::metrics
