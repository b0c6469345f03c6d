// Tests whether one of two samples lies above the other, and by how much. Comparisons of times rest on these.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "metrics/statistics.h"

namespace shadowbench::metrics {

// Bootstrap interval of median(current) / median(baseline) for independent samples: percentiles of 2,000 ratios, both
// samples resampled with `seed`. Values must be positive, and neither sample empty. (For pairs, take median_interval()
// of their ratios.)
Interval median_ratio_interval(std::span<const double> baseline, std::span<const double> current,
                               double confidence = 0.95, std::uint64_t seed = 1);

// Mann and Whitney 1947: the probability that two independent samples of one distribution have `above` over `below` at
// least as clearly as these. Equal values share their mean rank. Exact (Streitberg and Roehmel 1986) for up to 80
// values in all; beyond, the normal approximation with corrections for ties and continuity. 1 if either is empty.
double rank_sum_p(std::span<const double> above, std::span<const double> below);

// Wilcoxon 1945: the probability that differences that are symmetric around 0 lie above 0 at least as clearly as these.
// Differences of 0 are left out; equal sizes share their mean rank. Exact for up to 80 differences; beyond,
// approximated as in rank_sum_p(). 1 if no difference is left.
double signed_rank_p(std::span<const double> differences);

// Holm 1979: p values adjusted for the number of tests, in the order given. If those at or under alpha are called
// significant, the probability of rejecting even one true null hypothesis is at most alpha.
std::vector<double> holm(std::span<const double> p);

}  // namespace shadowbench::metrics
