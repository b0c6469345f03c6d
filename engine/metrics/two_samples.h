// Whether one of two samples lies above the other, and by how much: what a comparison of times rests on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "metrics/statistics.h"

namespace shadowbench::metrics {

// Bootstrap interval of median(current) / median(baseline), samples that were drawn apart from each other: percentiles
// of 2,000 ratios, both samples resampled with `seed`. Values are positive, and neither sample is empty. (Of pairs,
// take median_interval() of their ratios.)
Interval median_ratio_interval(std::span<const double> baseline, std::span<const double> current,
                               double confidence = 0.95, std::uint64_t seed = 1);

// Mann and Whitney 1947: the probability that two samples of one distribution, drawn apart, have `above` over `below`
// at least as clearly as these. Equal values share their mean rank. Exact (Streitberg and Roehmel 1986) up to 80 values
// in all; beyond, the normal approximation with corrections for ties and continuity. 1 where one of them is empty.
double rank_sum_p(std::span<const double> above, std::span<const double> below);

// Wilcoxon 1945: the probability that differences which are symmetric around 0 lie above 0 at least as clearly as
// these. Differences of 0 are left out, equal sizes share their mean rank. Exact up to 80 differences; beyond, as
// above. 1 where none is left.
double signed_rank_p(std::span<const double> differences);

// Holm 1979: each p value so enlarged that calling those at or under alpha significant is wrong of even one true null
// hypothesis with a probability of at most alpha. In the order given.
std::vector<double> holm(std::span<const double> p);

}  // namespace shadowbench::metrics
