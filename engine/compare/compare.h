// Compares two sides of measured cells: a verdict for every measure of every cell, and the changes of the fronts.
//
// Exact measures (bytes, nodes, errors, promises) are judged only by tolerance; they are the same on every machine.
//
// Times. The state of a process (where its memory lies, which other programs run) lasts as long as the process. So one
// process, not one repetition, is one observation: the median of its samples. On a two-core machine shared with other
// work, 24 runs of one program gave medians that differed by a factor of 1.3 to 6; fewer than 4 processes a side decide
// nothing.
//  - Interleaved sides (`ab`): process i of one side runs beside process i of the other. The ratios of the pairs' plain
//    times are judged. A disturbance affects both processes of a pair. A floor would only add its own noise, and
//    changes itself when a change touches other cache lines. Plain times of kernels are processor times. Interval:
//    bootstrap of the median; test: Wilcoxon's signed ranks.
//  - Otherwise: the medians of time over floor, which the machine's state changes less, or of plain times if there is
//    no floor. Interval: bootstrap of the ratio of medians; test: Mann and Whitney's rank sum. The minimum effect is
//    enlarged by the difference that two blocks of processes show without any change. If Embree's own queries, which
//    every result holds, show that the machine was in another state, only far larger differences are slower or faster.
//    If plain times are slower and their floor with them, the verdict is inconclusive. All this lowers the chance of a
//    false alarm on a shared machine; only pairs bound it.
// A time is slower if its whole interval is beyond the minimum effect and the test against that effect, not against
// equality, holds after Holm's correction over all judged times. One false alarm fails a build. So the probability of
// any false alarm, not their share, is kept under 5 %, however many cells there are.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "compare/measured.h"
#include "metrics/statistics.h"

namespace shadowbench::compare {

inline constexpr std::size_t fewest_processes = 4;
inline constexpr double block_noise = 0.03;        // difference of ratios to the floor between blocks of processes
inline constexpr double plain_block_noise = 0.06;  // the same for plain times
inline constexpr double machine_state = 1.15;  // beyond this factor of Embree's times the machine is in another state
inline constexpr double worst_state = 2.0;     // by how much more another state may slow other code than Embree

struct Options {
    double effect = 0.05;                     // smallest change of a time that counts
    std::map<std::string, double> tolerance;  // relative, of exact measures by name
    bool allow_missing = false;
    double alpha = 0.05;  // probability of any false alarm among all times
};

enum class Verdict {
    same,
    faster,
    slower,
    smaller,
    larger,
    more_accurate,
    less_accurate,
    inconclusive,    // only times
    not_comparable,  // another machine (only times), scenario, seed or version
    missing,         // not on the current side
    extra,           // not in the baseline
};
const char* to_string(Verdict verdict);

// One measure of one cell, or a whole cell or suite if nothing in it can be compared.
struct Line {
    std::string suite, group, cell;  // as in Measured; group and cell may be empty
    std::string measure;             // empty: all
    std::string unit;
    Verdict verdict = Verdict::same;
    bool time = false;
    double baseline = 0.0, current = 0.0;  // NaN: no value. For times: the medians that were judged
    // Set only for times that were judged:
    double ratio = 0.0;
    metrics::Interval interval{0.0, 0.0};
    std::size_t processes = 0;  // the fewer of the two sides; interleaved: pairs
    bool suspicious = false;    // looks slower, whatever the verdict
    bool fresh = false;         // judged again by confirm()
    double p_slower = 1.0, p_faster = 1.0;
    std::string reason;  // in words
    Rerun rerun;         // of the current side, if it has the cell
};
// "quickstart / key / deep tolerance=0.02"; empty parts are left out.
std::string title_of(const std::string& suite, const std::string& group, const std::string& cell);
std::string title_of(const Line& line);

struct FrontChange {
    std::string suite, group, cell;
    std::string front;  // "time and error" or "bytes and error"
    bool joined = false;
    bool perhaps = false;         // the intervals of the current result leave open whether the cell is on the front
    std::vector<std::string> by;  // the cells that beat it now (if it left) or before (if it joined)
};

struct Comparison {
    std::string baseline, current;  // names of the sides
    bool interleaved = false;
    Options options;
    std::size_t judged_times = 0;  // number of times in Holm's correction
    // The number of processes a side (or pairs) that can show a time to be slower, if some times have fewer; otherwise
    // 0.
    std::size_t enough = 0;
    std::vector<Line> lines;
    std::vector<FrontChange> fronts;
    std::vector<std::string> notes;
};

inline constexpr const char* over_floor = "x floor";  // the unit of such times

// The exit code of a line: 2 if it is larger, less accurate, missing or, in more than its time, not comparable (the
// last two unless allowed); 1 if it is slower; otherwise 0.
int code_of(const Line& line, const Options& options);

// The largest code of all lines.
int exit_code(const Comparison& comparison);

// Compares two sides. The caller sets the names `baseline` and `current` of the result. Throws only std::bad_alloc.
Comparison compare(const Measured& baseline, const Measured& current, const Options& options);

// The lines that look slower and whose cells can be run again: those worth a second look.
std::vector<Line> suspicious(const Comparison& comparison);

// A second look: `again` compares fresh processes of the suspicious cells only. A time that looked slower is slower
// only if the fresh processes show it without the first ones. Otherwise it is inconclusive, and its reason gives the
// figures of both looks. Fresh processes too few to show anything change no verdict.
void confirm(Comparison& first, const Comparison& again);

}  // namespace shadowbench::compare
