#include "results/settled.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace shadowbench::results {
namespace {

constexpr std::size_t most_named = 3;

// The quantile of a sorted sample at this share, interpolated linearly between neighbours.
double quantile(const std::vector<double>& sorted, double share) {
    const double place = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const double above = sorted[std::min(below + 1, sorted.size() - 1)];
    return sorted[below] + (place - static_cast<double>(below)) * (above - sorted[below]);
}

// The interquartile range over the median.
double spread_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return (quantile(values, 0.75) - quantile(values, 0.25)) / quantile(values, 0.5);
}

bool is_judged(const std::vector<double>& raw) {
    return raw.size() >= least_repetitions &&
           std::all_of(raw.begin(), raw.end(), [](double ns) { return std::isfinite(ns) && ns > 0.0; });
}

// The pace of each repetition: the median, over the floors, of its time over that floor's median.
std::vector<double> paces(const std::vector<const std::vector<double>*>& floors) {
    std::size_t repetitions = floors.front()->size();
    for (const auto* floor : floors) repetitions = std::min(repetitions, floor->size());
    std::vector<double> result;
    for (std::size_t r = 0; r < repetitions; ++r) {
        std::vector<double> relative;
        for (const auto* floor : floors) relative.push_back((*floor)[r] / metrics::median(*floor));
        result.push_back(metrics::median(relative));
    }
    return result;
}

}  // namespace

Settling settling(const LightResult& light) {
    Settling result;
    std::vector<const std::vector<double>*> floors;
    for (const Cell& cell : light.cells) {
        if (!cell.times) continue;
        for (const auto& [order, times] :
             {std::pair("image", &cell.times->image_order), std::pair("random", &cell.times->random_order)}) {
            if (!times->floor) continue;
            if (!is_judged(times->floor->raw)) {
                ++result.unjudged;
                continue;
            }
            floors.push_back(&times->floor->raw);
            const double spread = spread_of(times->floor->raw);
            if (spread > floor_limit) result.unsteady.push_back({title(cell), order, spread});
        }
    }
    result.floors = floors.size();
    std::stable_sort(result.unsteady.begin(), result.unsteady.end(),
                     [](const FloorSpread& a, const FloorSpread& b) { return a.spread > b.spread; });
    if (floors.size() >= least_floors) result.pace = spread_of(paces(floors));
    return result;
}

std::string unsettled_text(const Settling& settling) {
    std::string text;
    if (!settling.unsteady.empty()) {
        for (std::size_t i = 0; i < std::min(settling.unsteady.size(), most_named); ++i) {
            const FloorSpread& floor = settling.unsteady[i];
            text +=
                fmt::format("{}{}, {} order: {:.0f} %", i ? "; " : "", floor.cell, floor.order, 100.0 * floor.spread);
        }
        text = fmt::format("{} of {} floors spread{} by more than {:.0f} % ({}{})", settling.unsteady.size(),
                           settling.floors, settling.unsteady.size() == 1 ? "s" : "", 100.0 * floor_limit, text,
                           settling.unsteady.size() > most_named ? "; ..." : "");
    }
    if (settling.pace && *settling.pace > pace_limit)
        text += fmt::format("{}the pace of all floors together spreads by {:.0f} %, more than {:.0f} %",
                            text.empty() ? "" : ", and ", 100.0 * *settling.pace, 100.0 * pace_limit);
    return text;
}

std::optional<bool> settled(const Result& result) {
    std::optional<bool> all;
    for (const VariantResult& variant : result.variants)
        for (const LightResult& light : variant.lights)
            if (const Settling floors = settling(light); floors.floors > 0)
                all = all.value_or(true) && floors.settled();
    return all;
}

}  // namespace shadowbench::results
