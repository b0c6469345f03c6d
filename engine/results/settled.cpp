#include "results/settled.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "metrics/drift.h"

namespace shadowbench::results {
namespace {

constexpr std::size_t most_named = 3;
constexpr double unseen = 0.005;  // half of the last digit of the shortest times in a table

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

double half_width(const Sample& sample) {
    return 0.5 * (sample.interval.high - sample.interval.low);
}

void judge_floors(const LightResult& light, Settling& result) {
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
    if (floors.empty()) return;
    const std::vector<double> pace = paces(floors);
    if (floors.size() >= least_floors) result.pace = spread_of(pace);
    if (const std::optional<metrics::Line> line = metrics::drift(pace, drift_limit))
        result.drift = line->last / line->first - 1.0;
}

void judge_intervals(const LightResult& light, Settling& result) {
    if (!light.timing) return;
    result.goal = light.timing->goal;
    for (const Cell& cell : light.cells) {
        if (!cell.times) continue;
        for (const auto& [what, sample] :
             {std::pair("build", &cell.times->build_ms), std::pair("image order", &cell.times->image_order.ns),
              std::pair("random order", &cell.times->random_order.ns)}) {
            const std::optional<bool> narrow = is_settled(*sample, light);
            result.times += narrow.has_value();
            if (narrow == false) result.uncertain.push_back({title(cell), what, half_width(*sample) / sample->median});
        }
    }
    std::stable_sort(result.uncertain.begin(), result.uncertain.end(),
                     [](const UncertainTime& a, const UncertainTime& b) { return a.half_width > b.half_width; });
}

void judge_system(const TimingReport& timing, Settling& result) {
    const auto share = [](const TimedPasses& passes) -> std::optional<double> {
        if (passes.passes == 0) return {};
        return static_cast<double>(passes.interrupted) / static_cast<double>(passes.passes);
    };
    result.builds_interrupted = share(timing.builds);
    result.lookups_interrupted = share(timing.lookups);
    if (timing.steal_seconds && timing.seconds > 0.0) result.steal = *timing.steal_seconds / timing.seconds;
}

bool beyond(const std::optional<double>& share, double limit) {
    return share && *share > limit;
}

std::string floors_text(const Settling& settling) {
    std::string text;
    for (std::size_t i = 0; i < std::min(settling.unsteady.size(), most_named); ++i) {
        const FloorSpread& floor = settling.unsteady[i];
        text += fmt::format("{}{}, {} order: {:.0f} %", i ? "; " : "", floor.cell, floor.order, 100.0 * floor.spread);
    }
    return fmt::format("{} of {} floors spread{} by more than {:.0f} % ({}{})", settling.unsteady.size(),
                       settling.floors, settling.unsteady.size() == 1 ? "s" : "", 100.0 * floor_limit, text,
                       settling.unsteady.size() > most_named ? "; ..." : "");
}

std::string uncertain_text(const Settling& settling) {
    std::string text;
    for (std::size_t i = 0; i < std::min(settling.uncertain.size(), most_named); ++i) {
        const UncertainTime& time = settling.uncertain[i];
        text += fmt::format("{}{}, {}: {:.0f} %", i ? "; " : "", time.cell, time.what, 100.0 * time.half_width);
    }
    return fmt::format("{} of {} times {} uncertain by more than {:.3g} % ({}{})", settling.uncertain.size(),
                       settling.times, settling.uncertain.size() == 1 ? "is" : "are", 100.0 * settling.goal, text,
                       settling.uncertain.size() > most_named ? "; ..." : "");
}

// "a", "a, and b", "a, b, and c".
std::string listed(const std::vector<std::string>& parts) {
    std::string text;
    for (std::size_t i = 0; i < parts.size(); ++i)
        text += (i == 0 ? "" : i + 1 < parts.size() ? ", " : ", and ") + parts[i];
    return text;
}

std::vector<std::string> disturbances(const Settling& settling) {
    std::vector<std::string> parts;
    if (!settling.unsteady.empty()) parts.push_back(floors_text(settling));
    if (beyond(settling.pace, pace_limit))
        parts.push_back(fmt::format("the pace of all floors together spreads by {:.0f} %, more than {:.0f} %",
                                    100.0 * *settling.pace, 100.0 * pace_limit));
    if (settling.drift)
        parts.push_back(fmt::format("the floors became {:.0f} % {} from the first repetition to the last",
                                    100.0 * std::abs(*settling.drift), *settling.drift > 0.0 ? "slower" : "faster"));
    for (const auto& [what, share] :
         {std::pair("builds", settling.builds_interrupted), std::pair("lookups", settling.lookups_interrupted)})
        if (beyond(share, interrupted_limit))
            parts.push_back(
                fmt::format("other programs interrupted {:.0f} % of the timed passes of {}, more than "
                            "{:.0f} %",
                            100.0 * *share, what, 100.0 * interrupted_limit));
    if (beyond(settling.steal, steal_limit))
        parts.push_back(
            fmt::format("the host of this virtual machine took {:.1f} % of the time (steal), more than "
                        "{:.0f} %",
                        100.0 * *settling.steal, 100.0 * steal_limit));
    return parts;
}

}  // namespace

bool is_narrow(const Sample& sample, double goal) {
    return half_width(sample) <= std::max(unseen, goal * sample.median);
}

std::optional<bool> is_settled(const Sample& sample, const LightResult& light) {
    if (!light.timing || sample.raw.size() < least_repetitions) return {};
    return is_narrow(sample, light.timing->goal);
}

bool Settling::disturbed() const {
    return !unsteady.empty() || beyond(pace, pace_limit) || drift || beyond(builds_interrupted, interrupted_limit) ||
           beyond(lookups_interrupted, interrupted_limit) || beyond(steal, steal_limit);
}

Settling settling(const LightResult& light) {
    Settling result;
    judge_floors(light, result);
    judge_intervals(light, result);
    if (light.timing && result.known()) judge_system(*light.timing, result);
    return result;
}

std::string disturbance_text(const Settling& settling) {
    return listed(disturbances(settling));
}

std::string unsettled_text(const Settling& settling) {
    std::vector<std::string> parts = disturbances(settling);
    if (settling.uncertain.empty()) return listed(parts);
    std::string text = uncertain_text(settling);
    if (parts.empty())
        text +=
            ", though nothing shows that the machine was disturbed: allow more repetitions "
            "(timing.most_repetitions, timing.seconds)";
    parts.push_back(std::move(text));
    return listed(parts);
}

std::optional<bool> settled(const Result& result) {
    std::optional<bool> all;
    for (const VariantResult& variant : result.variants)
        for (const LightResult& light : variant.lights)
            if (const Settling found = settling(light); found.known()) all = all.value_or(true) && found.settled();
    return all;
}

std::string unsettled_line(const std::vector<const Result*>& results) {
    std::vector<std::string> named;
    std::size_t unsettled = 0, judged = 0;
    bool disturbed = false;
    for (const Result* result : results)
        for (std::size_t v = 0; v < result->variants.size(); ++v)
            for (const LightResult& light : result->variants[v].lights) {
                const Settling found = settling(light);
                judged += found.known();
                disturbed = disturbed || found.disturbed();
                if (found.settled() || ++unsettled > most_named) continue;
                std::string place = result->name;
                for (const document::Setting& setting : result->variants[v].settings)
                    place += fmt::format(" {}={}", setting.pointer, setting.value);
                named.push_back(fmt::format("{} light {}: {}", place, light.name, unsettled_text(found)));
            }
    if (named.empty()) return "";
    std::string text = fmt::format("UNSETTLED times of {} of {} light{}: ", unsettled, judged, judged == 1 ? "" : "s");
    for (std::size_t i = 0; i < named.size(); ++i) text += (i ? "; " : "") + named[i];
    if (unsettled > most_named) text += fmt::format("; and {} more", unsettled - most_named);
    return text + (disturbed ? ". Run again on a quiet machine.\n" : "\n");
}

}  // namespace shadowbench::results
