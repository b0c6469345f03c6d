#include "techniques/multi_depth/select_depths.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/parallel.h"

namespace shadowbench::techniques {
namespace {

// The middle of each of n groups of the sorted samples. The cell's own depth represents the group that it falls into.
void choose_of_groups(std::span<const float> sorted, float own, std::span<float> chosen) {
    const std::size_t q = sorted.size(), n = chosen.size();
    // Group g holds the ranks from floor(g q / n) to before floor((g + 1) q / n).
    for (std::size_t g = 0; g < n; ++g) chosen[g] = sorted[(g * q / n + (g + 1) * q / n) / 2];
    const std::size_t rank =
        static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), own) - sorted.begin());
    chosen[((rank + 1) * n - 1) / q] = own;
}

// The cell's own depth, then `nearest` samples from the front of the sorted ones and the others from their back.
void choose_of_ends(std::span<const float> sorted, float own, std::size_t nearest, std::span<float> chosen) {
    const std::size_t last = sorted.size() - 1;
    chosen[0] = own;
    for (std::size_t i = 1; i < chosen.size(); ++i)
        chosen[i] = i <= nearest ? sorted[std::min(i - 1, last)] : sorted[last - std::min(i - 1 - nearest, last)];
}

// Sorts `samples` only as far as the ends need: one from each end is found without sorting.
void sort_ends(std::span<float> samples, std::size_t nearest, std::size_t deepest) {
    if (nearest > 1 || deepest > 1) return std::sort(samples.begin(), samples.end());
    const auto [least, greatest] = std::minmax_element(samples.begin(), samples.end());
    const float low = *least, high = *greatest;
    samples.front() = low;
    samples.back() = high;
}

}  // namespace

std::vector<Offset> search_region(int q) {
    int rings = 0;
    while ((2 * rings + 1) * (2 * rings + 1) < q) ++rings;
    std::vector<Offset> offsets;
    for (int y = -rings; y <= rings; ++y)
        for (int x = -rings; x <= rings; ++x) offsets.push_back({x, y});
    const auto rank = [](const Offset& o) {
        return std::tuple(std::max(std::abs(o.x), std::abs(o.y)), o.x * o.x + o.y * o.y, o.y, o.x);
    };
    std::sort(offsets.begin(), offsets.end(), [&](const Offset& a, const Offset& b) { return rank(a) < rank(b); });
    offsets.resize(static_cast<std::size_t>(q));
    return offsets;
}

void select_depths(Selection selection, std::span<float> samples, std::span<float> chosen) {
    const float own = samples[0];
    const std::size_t others = chosen.size() - 1;
    if (std::all_of(samples.begin(), samples.end(), [own](float z) { return z == own; })) {
        std::fill(chosen.begin(), chosen.end(), own);
        return;
    }
    if (selection == Selection::sorted) {
        std::sort(samples.begin(), samples.end());
        choose_of_groups(samples, own, chosen);
    } else {
        const std::size_t nearest = selection == Selection::minimum ? others
                                    : selection == Selection::both  ? others / 2
                                                                    : 0;
        sort_ends(samples, nearest, others - nearest);
        choose_of_ends(samples, own, nearest, chosen);
    }
    std::sort(chosen.begin(), chosen.end());
}

std::vector<float> select_all(Selection selection, int q, int n, const CellGrid& grid, std::span<const float> base) {
    if (n == 1) return {base.begin(), base.end()};
    const std::vector<Offset> offsets = search_region(q);
    std::vector<std::ptrdiff_t> steps;  // the same in cells of the base map
    int rings = 0;
    for (const Offset& o : offsets) {
        steps.push_back(static_cast<std::ptrdiff_t>(o.y) * grid.width + o.x);
        rings = std::max({rings, std::abs(o.x), std::abs(o.y)});
    }
    std::vector<float> all(grid.count() * static_cast<std::size_t>(n));
    base::parallel_for(static_cast<std::size_t>(grid.height), [&](std::size_t row) {
        std::vector<float> samples(offsets.size());
        const int y = static_cast<int>(row);
        const bool row_inside = y >= rings && y < grid.height - rings;
        for (int x = 0; x < grid.width; ++x) {
            if (row_inside && x >= rings && x < grid.width - rings) {
                const float* own = base.data() + grid.index(x, y);
                for (std::size_t s = 0; s < steps.size(); ++s) samples[s] = own[steps[s]];
            } else {
                for (std::size_t s = 0; s < offsets.size(); ++s)
                    samples[s] = base[grid.index(std::clamp(x + offsets[s].x, 0, grid.width - 1),
                                                 std::clamp(y + offsets[s].y, 0, grid.height - 1))];
            }
            select_depths(selection, samples,
                          {all.data() + grid.index(x, y) * static_cast<std::size_t>(n), static_cast<std::size_t>(n)});
        }
    });
    return all;
}

}  // namespace shadowbench::techniques
