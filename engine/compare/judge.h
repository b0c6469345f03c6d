// One measure on two sides. Internal to compare.cpp.
#pragma once

#include "compare/compare.h"

namespace shadowbench::compare {

// The tolerance of a measure: as told, or none for sizes, 1e-6 for errors, 1e-3 for instructions. Relative to the
// baseline; of errors 1e-12 is added, so that a baseline of 0 has one.
double tolerance_of(const Exact& exact, const Options& options);

// Fills verdict, values and reason.
void judge_exact(const Exact& baseline, const Exact& current, const Options& options, Line& line);

// Fills verdict (but for chance among many: apply_holm), values, interval, p and reason.
// `machine`: what was run beside, but does not change, took so many times as long on the current side.
void judge_time(const Timed& baseline, const Timed& current, bool interleaved, double machine, const Options& options,
                Line& line);

// Processes a side (pairs, where interleaved) that can call one of so many times slower: with fewer, even the smallest
// p value is above alpha after Holm's correction.
std::size_t enough_processes(std::size_t times, bool interleaved, double alpha);

// Takes back what is not beyond chance among all times judged.
void apply_holm(Comparison& comparison);

// What became of the fronts of cells that have the same suite and group. Values count as changed only where their
// verdict says so: noise moves no front.
struct FrontCell {
    const Cell* baseline = nullptr;  // null: extra
    const Cell* current = nullptr;   // null: missing
};
std::vector<FrontChange> front_changes(const std::string& suite, const std::string& group,
                                       const std::vector<FrontCell>& cells, const std::vector<Line>& lines,
                                       bool times_compare);

}  // namespace shadowbench::compare
