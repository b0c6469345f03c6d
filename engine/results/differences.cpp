#include "results/differences.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "metrics/student.h"
#include "results/fronts.h"
#include "results/settled.h"

namespace shadowbench::results {
namespace {

using metrics::Interval;

constexpr Interval anything{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

std::vector<double> mean_squares_of(const Cell& cell) {
    std::vector<double> values{cell.lookup->norms.rms * cell.lookup->norms.rms};
    for (const SeedErrors& seed : cell.over_seeds) values.push_back(seed.lookup.rms * seed.lookup.rms);
    return values;
}

std::vector<double> bytes_of(const Cell& cell) {
    std::vector<double> values{static_cast<double>(cell.bytes)};
    for (const SeedErrors& seed : cell.over_seeds) values.push_back(static_cast<double>(seed.bytes));
    return values;
}

bool knows_other_rays(const Cell& cell) {
    return !cell.over_seeds.empty() || (cell.lookup->interval && cell.lookup->interval->covers_rays);
}

// The interval of a - b, given their values seed by seed, with a further error of this standard deviation.
Interval paired(const std::vector<double>& a, const std::vector<double>& b, double known_sd, double tail) {
    if (a.size() != b.size()) return anything;
    std::vector<double> differences(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (!std::isfinite(a[i]) || !std::isfinite(b[i])) return anything;
        differences[i] = a[i] - b[i];
    }
    const metrics::MeanAndVariance mean = metrics::mean_and_variance(differences);
    if (mean.mean == 0.0 && mean.variance == 0.0) return {0.0, 0.0};  // a tie, whatever the truth
    return metrics::mean_interval(mean, known_sd * known_sd, tail);
}

// The same for the logarithms of times.
Interval paired_times(const std::vector<double>& a, const std::vector<double>& b, double tail) {
    const std::size_t pairs = std::min(a.size(), b.size());
    if (pairs < least_repetitions) return anything;
    std::vector<double> ratios(pairs);
    for (std::size_t i = 0; i < pairs; ++i) {
        if (!(a[i] > 0.0 && b[i] > 0.0)) return anything;
        ratios[i] = std::log(a[i] / b[i]);
    }
    const Interval mean = metrics::mean_interval(metrics::mean_and_variance(ratios), 0.0, tail);
    const double luck = std::log1p(process_luck);
    return {mean.low - luck, mean.high + luck};
}

}  // namespace

std::vector<std::size_t> comparable(const LightResult& light, bool timed) {
    std::vector<std::size_t> cells;
    for (std::size_t i = 0; i < light.cells.size(); ++i) {
        const Cell& cell = light.cells[i];
        if (cell.status == CellStatus::ok && cell.lookup && std::isfinite(cell.lookup->norms.rms) &&
            (!timed || cell.times))
            cells.push_back(i);
    }
    return cells;
}

bool times_count(const LightResult& light) {
    const Settling floors = settling(light);
    return floors.floors > 0 && !floors.disturbed();
}

Differences::Differences(const LightResult& light, std::vector<std::size_t> cells)
    : light_(light), cells_(std::move(cells)), tail_(metrics::tail_of_front(cells_.size(), front_confidence)) {
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        errors_.push_back(mean_squares_of(cell(i)));
        bytes_.push_back(bytes_of(cell(i)));
        certain_.push_back(knows_other_rays(cell(i)));
    }
}

const Cell& Differences::cell(std::size_t i) const {
    return light_.cells[cells_[i]];
}

Interval Differences::errors(std::size_t a, std::size_t b) const {
    if (!certain_[a] || !certain_[b]) return anything;
    return paired(errors_[a], errors_[b], cell(a).lookup->truth_sd + cell(b).lookup->truth_sd, tail_);
}

Interval Differences::bytes(std::size_t a, std::size_t b) const {
    if (!certain_[a] || !certain_[b]) return anything;
    return paired(bytes_[a], bytes_[b], 0.0, tail_);
}

Interval Differences::times(std::size_t a, std::size_t b) const {
    return paired_times(cell(a).times->random_order.ns.raw, cell(b).times->random_order.ns.raw, tail_);
}

double Differences::mean_bytes(std::size_t i) const {
    return metrics::mean_and_variance(bytes_[i]).mean;
}

}  // namespace shadowbench::results
