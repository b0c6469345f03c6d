// Marks the cells on the fronts of time against error and of bytes against error.
#pragma once

#include "results/result.h"

namespace shadowbench::results {

// The probability that all marks `certainly` and `no` of one front are right, as far as their intervals know what
// varies.
inline constexpr double front_confidence = 0.95;

// A process keeps its luck: where its memory lies, and what else runs on the machine. So the ratio of two times that
// one process measures may be off by this share, whatever their repetitions say: the difference that blocks of
// processes of one program show (see compare/compare.h).
inline constexpr double process_luck = 0.06;

// Marks the cells of one light that no other cell beats: in lookup time (random order) and lookup error (RMS), and in
// bytes and lookup error. Marks are defined in metrics/interval_front.h; front_confidence is shared out over all pairs
// of cells and both values by Bonferroni's inequality. Failed cells are on no front.
//  - Errors and bytes are compared over seeds of the rays: the own one and those of Cell::over_seeds. All cells see
//    the same rays, so differences are paired; their mean has Student's interval. The errors are mean squares. Their
//    common truth adds an independent normal error, of at most the sum of both cells' LookupErrors::truth_sd. If the
//    rays are not random, the values are exact but for that. If they are, and were not measured over seeds, nothing is
//    known of other rays, and so no difference is certain.
//  - Times are compared by Student's interval of the mean log ratio of the repetitions. These are interleaved, so the
//    pace of the machine cancels in each ratio. (Bootstrap and rank intervals cannot reach the confidence that one of
//    many pairs needs: the widest interval of nine values without a model of their distribution, from the least to the
//    largest, holds with 99.6 %.) The interval is widened by process_luck at both ends.
//  - If the machine was disturbed, or nothing is known of it (settled.h), times are not to be relied on: every cell that has
//    times is perhaps on the front of time. A cell with fewer than least_repetitions repetitions is compared with no
//    other by time.
void mark_fronts(LightResult& light);

}  // namespace shadowbench::results
