#include "metrics/two_samples.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "base/random.h"

namespace shadowbench::metrics {
namespace {

constexpr std::size_t most_exact = 80;

double upper_tail(double z) {
    return 0.5 * std::erfc(z / std::sqrt(2.0));
}

// `doubled`: twice the mean rank of each value, a whole number from 2 on. `ties`: the sum of t^3 - t over groups of t
// equal values.
struct Ranks {
    std::vector<std::size_t> doubled;
    double ties = 0.0;
};

Ranks ranks_of(std::span<const double> values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    Ranks ranks{std::vector<std::size_t>(values.size()), 0.0};
    for (std::size_t i = 0; i < order.size();) {
        std::size_t end = i + 1;
        while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
        for (std::size_t k = i; k < end; ++k) ranks.doubled[order[k]] = i + 1 + end;
        const double t = static_cast<double>(end - i);
        ranks.ties += t * t * t - t;
        i = end;
    }
    return ranks;
}

// The share of all subsets of `size` of these scores whose sum is at least `least`. Doubles count exactly up to 2^53;
// beyond, the relative error is too small to change a verdict.
double share_of_subsets(std::span<const std::size_t> scores, std::size_t size, std::size_t least) {
    const std::size_t most = std::accumulate(scores.begin(), scores.end(), std::size_t{0});
    std::vector<std::vector<double>> ways(size + 1, std::vector<double>(most + 1, 0.0));
    ways[0][0] = 1.0;
    for (const std::size_t score : scores)
        for (std::size_t k = size; k > 0; --k)
            for (std::size_t sum = most; sum >= score; --sum) ways[k][sum] += ways[k - 1][sum - score];
    double all = 0.0, beyond = 0.0;
    for (std::size_t sum = 0; sum <= most; ++sum) {
        all += ways[size][sum];
        if (sum >= least) beyond += ways[size][sum];
    }
    return beyond / all;
}

// The share of all choices of signs for these scores whose positive scores sum to at least `least`.
double share_of_signs(std::span<const std::size_t> scores, std::size_t least) {
    const std::size_t most = std::accumulate(scores.begin(), scores.end(), std::size_t{0});
    std::vector<double> share(most + 1, 0.0);
    share[0] = 1.0;
    for (const std::size_t score : scores) {
        for (std::size_t sum = most + 1; sum-- > 0;)
            share[sum] = 0.5 * (share[sum] + (sum >= score ? share[sum - score] : 0.0));
    }
    double beyond = 0.0;
    for (std::size_t sum = least; sum <= most; ++sum) beyond += share[sum];
    return beyond;
}

}  // namespace

Interval median_ratio_interval(std::span<const double> baseline, std::span<const double> current, double confidence,
                               std::uint64_t seed) {
    constexpr std::size_t resamples = 2000;
    base::Random random(base::mix(seed));
    std::vector<double> drawn, ratios(resamples);
    const auto resampled_median = [&](std::span<const double> sample) {
        drawn.resize(sample.size());
        for (double& value : drawn) value = sample[random.below(sample.size())];
        return median(drawn);
    };
    for (double& ratio : ratios) {
        const double below = resampled_median(baseline);
        ratio = resampled_median(current) / below;
    }
    std::sort(ratios.begin(), ratios.end());
    const double tail = 0.5 * (1.0 - std::clamp(confidence, 0.0, 1.0));
    const auto low = std::min(static_cast<std::size_t>(std::floor(tail * resamples)), resamples / 2 - 1);
    return {ratios[low], ratios[resamples - 1 - low]};
}

double rank_sum_p(std::span<const double> above, std::span<const double> below) {
    if (above.empty() || below.empty()) return 1.0;
    std::vector<double> all(above.begin(), above.end());
    all.insert(all.end(), below.begin(), below.end());
    const Ranks ranks = ranks_of(all);
    const std::size_t sum = std::accumulate(
        ranks.doubled.begin(), ranks.doubled.begin() + static_cast<std::ptrdiff_t>(above.size()), std::size_t{0});
    if (all.size() <= most_exact) return share_of_subsets(ranks.doubled, above.size(), sum);
    const double n = static_cast<double>(above.size()), m = static_cast<double>(below.size()), total = n + m;
    const double mean = 0.5 * n * (total + 1.0);
    const double variance = n * m / 12.0 * (total + 1.0 - ranks.ties / (total * (total - 1.0)));
    if (variance <= 0.0) return 1.0;
    return upper_tail((0.5 * static_cast<double>(sum) - mean - 0.5) / std::sqrt(variance));
}

double signed_rank_p(std::span<const double> differences) {
    std::vector<double> sizes;
    std::vector<bool> positive;
    for (const double difference : differences) {
        if (difference == 0.0) continue;
        sizes.push_back(std::abs(difference));
        positive.push_back(difference > 0.0);
    }
    if (sizes.empty()) return 1.0;
    const Ranks ranks = ranks_of(sizes);
    std::size_t sum = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i)
        if (positive[i]) sum += ranks.doubled[i];
    if (sizes.size() <= most_exact) return share_of_signs(ranks.doubled, sum);
    const double n = static_cast<double>(sizes.size());
    const double mean = n * (n + 1.0) / 4.0;
    const double variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ranks.ties / 48.0;
    return upper_tail((0.5 * static_cast<double>(sum) - mean - 0.5) / std::sqrt(variance));
}

std::vector<double> holm(std::span<const double> p) {
    std::vector<std::size_t> order(p.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
    std::vector<double> adjusted(p.size());
    double largest = 0.0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        largest = std::max(largest, std::min(1.0, p[order[i]] * static_cast<double>(p.size() - i)));
        adjusted[order[i]] = largest;
    }
    return adjusted;
}

}  // namespace shadowbench::metrics
