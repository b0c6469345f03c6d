// Judges single measures, and the fronts. Internal to compare.cpp.
#pragma once

#include "compare/compare.h"

namespace shadowbench::compare {

// The tolerance of a measure relative to the baseline: as given in the options, or 0 for sizes, 1e-6 for errors, 1e-3
// for instructions. Errors may also differ by 1e-12, so that a baseline of 0 has a tolerance.
double tolerance_of(const Exact& exact, const Options& options);

// Fills verdict, values and reason.
void judge_exact(const Exact& baseline, const Exact& current, const Options& options, Line& line);

// Fills verdict, values, interval, p and reason. apply_holm() then takes account of chance among many times.
// `machine` is the factor by which work that does not change took longer on the current side.
void judge_time(const Timed& baseline, const Timed& current, bool interleaved, double machine, const Options& options,
                Line& line);

// The number of processes a side (or pairs) that can show one of `times` times to be slower. With fewer, even the
// smallest possible p value is above alpha after Holm's correction.
std::size_t enough_processes(std::size_t times, bool interleaved, double alpha);

// Makes verdicts inconclusive that may be chance among all judged times.
void apply_holm(Comparison& comparison);

// The changes of the fronts of cells of the same suite and group. A value counts as changed only if its verdict says
// so: noise moves no front. A change is left out if the intervals of the current result contradict it: the cell is then
// certainly on the front that it would have left, or certainly not on the one that it would have joined.
struct FrontCell {
    const Cell* baseline = nullptr;  // null: extra
    const Cell* current = nullptr;   // null: missing
};
std::vector<FrontChange> front_changes(const std::string& suite, const std::string& group,
                                       const std::vector<FrontCell>& cells, const std::vector<Line>& lines,
                                       bool times_compare);

}  // namespace shadowbench::compare
