#include "results/fronts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "metrics/student.h"
#include "results/settled.h"

namespace shadowbench::results {
namespace {

using metrics::Interval;
using metrics::OnFront;

constexpr Interval anything{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

std::vector<double> mean_squares(const Cell& cell) {
    std::vector<double> values{cell.lookup->norms.rms * cell.lookup->norms.rms};
    for (const SeedErrors& seed : cell.over_seeds) values.push_back(seed.lookup.rms * seed.lookup.rms);
    return values;
}

std::vector<double> bytes(const Cell& cell) {
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

struct Choice {
    Cell* cell;
    bool certain;                // of other rays
    std::vector<double> errors;  // mean squares, seed by seed
    std::vector<double> bytes;
};

std::vector<OnFront> front_of(const std::vector<Choice>& choices, const metrics::Difference& cost, double tail) {
    return metrics::front_of_intervals(choices.size(), cost, [&](std::size_t a, std::size_t b) {
        const Choice &one = choices[a], &other = choices[b];
        if (!one.certain || !other.certain) return anything;
        return paired(one.errors, other.errors, one.cell->lookup->truth_sd + other.cell->lookup->truth_sd, tail);
    });
}

void mark_bytes(const std::vector<Choice>& choices) {
    const double tail = metrics::tail_of_front(choices.size(), front_confidence);
    const auto difference = [&](std::size_t a, std::size_t b) {
        if (!choices[a].certain || !choices[b].certain) return anything;
        return paired(choices[a].bytes, choices[b].bytes, 0.0, tail);
    };
    const std::vector<OnFront> marks = front_of(choices, difference, tail);
    for (std::size_t i = 0; i < choices.size(); ++i) choices[i].cell->on_bytes_front = marks[i];
}

void mark_times(std::vector<Choice> choices, bool known) {
    std::erase_if(choices, [](const Choice& choice) { return !choice.cell->times; });
    const double tail = metrics::tail_of_front(choices.size(), front_confidence);
    const auto difference = [&](std::size_t a, std::size_t b) {
        return paired_times(choices[a].cell->times->random_order.ns.raw, choices[b].cell->times->random_order.ns.raw,
                            tail);
    };
    std::vector<OnFront> marks(choices.size(), OnFront::perhaps);
    if (known) marks = front_of(choices, difference, tail);
    for (std::size_t i = 0; i < choices.size(); ++i) choices[i].cell->times->on_front = marks[i];
}

}  // namespace

void mark_fronts(LightResult& light) {
    const Settling floors = settling(light);
    std::vector<Choice> choices;
    for (Cell& cell : light.cells) {
        cell.on_bytes_front = OnFront::no;
        if (cell.times) cell.times->on_front = OnFront::no;
        if (cell.status == CellStatus::ok && cell.lookup && std::isfinite(cell.lookup->norms.rms))
            choices.push_back({&cell, knows_other_rays(cell), mean_squares(cell), bytes(cell)});
    }
    mark_bytes(choices);
    mark_times(std::move(choices), floors.floors > 0 && !floors.disturbed());
}

}  // namespace shadowbench::results
