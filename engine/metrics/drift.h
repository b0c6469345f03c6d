// Finds slow change along a series of results, which no comparison of neighbours shows.
#pragma once

#include <optional>
#include <span>

namespace shadowbench::metrics {

// Kendall 1938, Mann 1945: the probability (two-sided) that a series without a trend rises or falls at least as clearly
// as these values. Exact for up to 60 values that all differ; otherwise the normal approximation, corrected for ties
// and continuity. 1 for fewer than two values.
double trend_p(std::span<const double> values);

// A straight line through (0, values[0]), (1, values[1]), ... that outliers do not move: its slope is the median of all
// pairwise slopes (Theil 1950, Sen 1968), its first value the median of the starts of lines of that slope through each
// value.
struct Line {
    double first, last;  // at the first and the last value
};
Line robust_line(std::span<const double> values);

// The line, if the values follow it: trend_p() is at most 0.01, and the line changes by more than the factor 1 + least,
// up or down (values of one sign; others by any amount). Absent for fewer than six values.
std::optional<Line> drift(std::span<const double> values, double least);

}  // namespace shadowbench::metrics
