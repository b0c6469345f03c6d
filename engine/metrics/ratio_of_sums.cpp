#include "metrics/ratio_of_sums.h"

#include <algorithm>
#include <cmath>

namespace shadowbench::metrics {

Interval ratio_interval(std::span<const double> a, std::span<const double> b, std::size_t population) {
    double sum_a = 0.0, sum_b = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum_a += a[i];
        sum_b += b[i];
    }
    const double ratio = sum_a / sum_b, n = static_cast<double>(a.size());
    if (a.size() < 2 || a.size() >= population) return {ratio, ratio};
    for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - ratio * b[i]) * (a[i] - ratio * b[i]);
    const double unseen = 1.0 - n / static_cast<double>(population);
    const double deviation = std::sqrt(unseen * n * squares / (n - 1.0)) / sum_b;
    return {ratio - 1.959964 * deviation, ratio + 1.959964 * deviation};
}

}  // namespace shadowbench::metrics
