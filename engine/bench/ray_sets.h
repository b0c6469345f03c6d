// The mean over the rays of a footprint, and its standard error: from one set of rays, or from several independent
// ones. Internal to reference.cpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bench/gather.h"

namespace shadowbench::bench {

struct Mean {
    double value, standard_error;
};

// One channel of the rays of one set (at least one ray). The standard error takes them for independent. It is an upper
// bound, since rays spread evenly (jittered cells) do better. That of one ray is unknown: 0.5, the largest deviation of
// values in [0, 1].
Mean mean_of_rays(const Moments& rays, int channel);

// The sum and the number of the rays in a footprint, for each of K >= 2 independent sets. Some set holds a ray.
//
// The value is sum S_k / sum C_k, the mean of all rays. (The mean of the sets' means is the same where each set has as
// many rays inside; elsewhere its bias is K times as large, since that of a ratio falls with the number of rays.)
// The standard error is that of a ratio of means (Cochran, Sampling Techniques, 1977, section 2.11), with K - 1 degrees
// of freedom: sqrt(K / (K - 1) sum (S_k - value C_k)^2) / sum C_k.
// Where only m < K sets hold a ray, m replaces K; then the error is widened, up to 0.5, so that the 95 % interval of K
// - 1 degrees of freedom is that of m - 1. For m = 1 it is 0.5: unknown.
Mean mean_of_sets(std::span<const double> sums, std::span<const std::uint64_t> counts);

// The sums of all queries.
class SetSums {
public:
    SetSums(std::size_t queries, std::size_t sets, std::size_t channels)
        : sets_(sets), channels_(channels), sum_(queries * sets * channels), count_(queries * sets) {}

    void set(std::size_t query, std::size_t set, const Moments& rays) {
        count_[query * sets_ + set] = rays.count;
        for (std::size_t c = 0; c < channels_; ++c) sum_[(query * channels_ + c) * sets_ + set] = rays.sum[c];
    }
    std::span<const double> of(std::size_t query, std::size_t channel) const {
        return std::span(sum_).subspan((query * channels_ + channel) * sets_, sets_);
    }
    std::span<const std::uint64_t> counts(std::size_t query) const {
        return std::span(count_).subspan(query * sets_, sets_);
    }
    bool empty(std::size_t query) const {
        return std::ranges::all_of(counts(query), [](std::uint64_t count) { return count == 0; });
    }

private:
    std::size_t sets_, channels_;
    std::vector<double> sum_;
    std::vector<std::uint64_t> count_;
};

}  // namespace shadowbench::bench
