#include "metrics/drift.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "metrics/statistics.h"

namespace shadowbench::metrics {
namespace {

constexpr double alpha = 0.01;
constexpr std::size_t fewest = 6, most_exact = 60;  // no order of 5 values is as rare as alpha

// The share of all orders of n different values that have at most this many pairs in falling order.
double share_of_orders(std::size_t n, std::size_t falling) {
    std::vector<double> share{1.0};
    for (std::size_t k = 2; k <= n; ++k) {
        std::vector<double> next(share.size() + k - 1, 0.0);
        for (std::size_t i = 0; i < share.size(); ++i)
            for (std::size_t j = 0; j < k; ++j) next[i + j] += share[i] / static_cast<double>(k);
        share = std::move(next);
    }
    double sum = 0.0;
    for (std::size_t i = 0; i <= falling && i < share.size(); ++i) sum += share[i];
    return sum;
}

double cube_of_ties(std::span<const double> values) {
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    double sum = 0.0;
    for (auto group = sorted.begin(); group != sorted.end();) {
        const auto end = std::upper_bound(group, sorted.end(), *group);
        const double t = static_cast<double>(end - group);
        sum += t * (t - 1.0) * (2.0 * t + 5.0);
        group = end;
    }
    return sum;
}

}  // namespace

double trend_p(std::span<const double> values) {
    std::size_t rising = 0, falling = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        for (std::size_t j = i + 1; j < values.size(); ++j) {
            rising += values[j] > values[i];
            falling += values[j] < values[i];
        }
    const std::size_t pairs = values.size() * (values.size() - std::min<std::size_t>(1, values.size())) / 2;
    if (rising == falling) return 1.0;
    if (rising + falling == pairs && values.size() <= most_exact)
        return std::min(1.0, 2.0 * share_of_orders(values.size(), std::min(rising, falling)));
    const double n = static_cast<double>(values.size());
    const double variance = (n * (n - 1.0) * (2.0 * n + 5.0) - cube_of_ties(values)) / 18.0;
    const double score = std::abs(static_cast<double>(rising) - static_cast<double>(falling)) - 1.0;
    return std::erfc(score / std::sqrt(2.0 * variance));
}

Line robust_line(std::span<const double> values) {
    if (values.size() < 2) return values.empty() ? Line{0.0, 0.0} : Line{values[0], values[0]};
    std::vector<double> slopes, starts;
    for (std::size_t i = 0; i < values.size(); ++i)
        for (std::size_t j = i + 1; j < values.size(); ++j)
            slopes.push_back((values[j] - values[i]) / static_cast<double>(j - i));
    const double slope = median(slopes);
    for (std::size_t i = 0; i < values.size(); ++i) starts.push_back(values[i] - slope * static_cast<double>(i));
    const double first = median(starts);
    return {first, first + slope * static_cast<double>(values.size() - 1)};
}

std::optional<Line> drift(std::span<const double> values, double least) {
    if (values.size() < fewest || trend_p(values) > alpha) return std::nullopt;
    const Line line = robust_line(values);
    if (line.first == line.last) return std::nullopt;
    const double small = std::min(std::abs(line.first), std::abs(line.last));
    const double large = std::max(std::abs(line.first), std::abs(line.last));
    if (line.first * line.last > 0.0 && large <= small * (1.0 + least)) return std::nullopt;
    return line;
}

}  // namespace shadowbench::metrics
