// Two sides of measured cells -> a verdict for every measure of every cell, and what became of the fronts.
//
// Exact measures (bytes, nodes, errors, promises) are judged by tolerance alone; they hold on any machine.
//
// Times. What a process has once it keeps (where its memory lies, who else is on the machine), so a process, not a
// repetition, is one observation: the median of its samples. On a two-core machine shared with other work, 24
// runs of one program gave medians that lay a factor of 1.3 to 6 apart: fewer than 4 processes a side decide nothing.
//  - Interleaved sides (`ab`): process i of one beside process i of the other. Judged are the pairs' ratios of plain
//    times: what disturbs a pair disturbs both, and a floor would only add its own noise (and moves itself when a
//    change touches other lines). Plain times of kernels are the processor's. Interval: bootstrap of the median; test:
//    Wilcoxon's signed ranks.
//  - Otherwise: the medians of time over floor, which the machine's state moves less; of times without a floor the
//    plain ones. Interval: bootstrap of the ratio of medians; test: Mann-Whitney's rank sum. What two blocks of
//    processes differ in without any change is added to the minimum effect; and where Embree's own queries, which stand
//    in every result, say that the machine was in another state, only what differs by far more is slower or faster.
//    Where plain times are slower and their floor with them, it is inconclusive. All that lowers the chance of a false
//    alarm on a shared machine; only pairs bound it.
// A time is slower when its whole interval is beyond the minimum effect AND the test against that effect, not against
// equality, holds after Holm's correction over all times that were judged: one false alarm fails a build, so the chance
// of any one, not their share, is held under 5 %, however many cells there are.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "compare/measured.h"
#include "metrics/statistics.h"

namespace shadowbench::compare {

inline constexpr std::size_t fewest_processes = 4;
inline constexpr double block_noise = 0.03;        // of ratios to the floor, between blocks of processes
inline constexpr double plain_block_noise = 0.06;  // of plain times
inline constexpr double machine_state = 1.15;      // Embree's queries took so much longer: another state of the machine
inline constexpr double worst_state = 2.0;  // what another state slows some code by, beside what it slows Embree by

struct Options {
    double effect = 0.05;                     // of times: smaller changes are none
    std::map<std::string, double> tolerance;  // of an exact measure, relative, by its name
    bool allow_missing = false;
    double alpha = 0.05;  // of any false alarm among all times
};

enum class Verdict {
    same,
    faster,
    slower,
    smaller,
    larger,
    more_accurate,
    less_accurate,
    inconclusive,    // times alone
    not_comparable,  // another machine (times alone), scenario, seed or version
    missing,         // not in the current side
    extra,           // not in the baseline
};
const char* to_string(Verdict verdict);

// One measure of one cell, or a whole cell or suite where nothing of it can be compared.
struct Line {
    std::string suite, group, cell;  // as in Measured; group and cell may be empty
    std::string measure;             // empty: all
    std::string unit;
    Verdict verdict = Verdict::same;
    bool time = false;
    double baseline = 0.0, current = 0.0;  // NaN: there is none. Of times: medians of what was judged
    // Times that were judged, else 0 and empty:
    double ratio = 0.0;
    metrics::Interval interval{0.0, 0.0};
    std::size_t processes = 0;  // the fewer of the two sides; interleaved: pairs
    bool suspicious = false;    // looks slower, whatever the verdict
    bool fresh = false;         // judged anew by confirm()
    double p_slower = 1.0, p_faster = 1.0;
    std::string reason;  // in words
    Rerun rerun;         // of the current side, where it has the cell
};
std::string title_of(const Line& line);  // "quickstart / key / deep tolerance=0.02"

struct FrontChange {
    std::string suite, group, cell;
    std::string front;  // "time and error" or "bytes and error"
    bool joined = false;
    std::vector<std::string> by;  // left: who beats it now; joined: who beat it before
};

struct Comparison {
    std::string baseline, current;  // what the sides are called
    bool interleaved = false;
    Options options;
    std::size_t judged_times = 0;  // that Holm's correction is over
    // Where some of them have too few processes to be called slower, however slow: how many a side (pairs) are enough.
    std::size_t enough = 0;
    std::vector<Line> lines;
    std::vector<FrontChange> fronts;
    std::vector<std::string> notes;
};

inline constexpr const char* over_floor = "x floor";  // the unit of such times

// What a line asks for: 2 where it is larger, less accurate, missing or, other than for its time, not comparable (the
// last two unless they are allowed); 1 where it is slower; else 0.
int code_of(const Line& line, const Options& options);

// The largest of all lines.
int exit_code(const Comparison& comparison);

// Compares sides; each is named as the report shall call it. Throws nothing but std::bad_alloc.
Comparison compare(const Measured& baseline, const Measured& current, const Options& options);

// The cells that look slower, of those that a rerun can be named for: what a second look is worth.
std::vector<Line> suspicious(const Comparison& comparison);

// A second look: `again` compares fresh processes of the suspicious cells alone. What looked slower is slower only
// where it is so in the fresh ones by themselves; else it is inconclusive, and says what both looks gave. Fresh ones
// too few to show anything change no verdict.
void confirm(Comparison& first, const Comparison& again);

}  // namespace shadowbench::compare
