#include "compare/words.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "compare/report.h"

namespace shadowbench::compare {
namespace {

int severity(Verdict verdict) {
    switch (verdict) {
        case Verdict::less_accurate:
            return 0;
        case Verdict::larger:
            return 1;
        case Verdict::missing:
            return 2;
        case Verdict::slower:
            return 3;
        case Verdict::not_comparable:
            return 4;
        case Verdict::inconclusive:
            return 5;
        case Verdict::extra:
            return 9;
        case Verdict::same:
            return 10;
        default:
            return 6;
    }
}

std::string value_text(double value, bool time) {
    if (std::isnan(value)) return "none";
    if (time) return fmt::format("{:.4g}", value);
    return value == std::floor(value) && std::abs(value) < 1e15 ? fmt::format("{:.0f}", value)
                                                                : fmt::format("{:.7g}", value);
}

std::string percent(double factor) {
    return fmt::format("{:.1f} %", 100.0 * (factor - 1.0));
}

}  // namespace

std::string method(const Comparison& comparison) {
    if (comparison.judged_times == 0)
        return fmt::format("no time was judged: that needs {} or more processes a side on one machine",
                           fewest_processes);
    const std::string effect = fmt::format("{:g} %", 100.0 * comparison.options.effect);
    const std::string of = comparison.interleaved
                               ? fmt::format("plain times of interleaved pairs; minimum effect {}", effect)
                               : fmt::format(
                                     "medians of processes, over the floor if there is one; minimum effect {}, and "
                                     "{:g} % more ({:g} % without a floor), by which blocks of processes differ",
                                     effect, 100.0 * block_noise, 100.0 * plain_block_noise);
    std::string text = fmt::format(
        "{} times judged: {}. A time is slower or faster if its whole 95 % bootstrap interval is beyond that effect "
        "and the test against it holds after Holm's correction over all times. At most 5 % of comparisons then raise "
        "any "
        "false alarm{}",
        comparison.judged_times, of,
        comparison.interleaved ? "" : ", if the machine was in the same state for both blocks");
    if (comparison.enough > 0)
        text += fmt::format(". There are too few processes to call a time slower, however slow: {} times need {} {}",
                            comparison.judged_times, comparison.enough,
                            comparison.interleaved ? "pairs" : "processes a side");
    return text;
}

std::string values_text(const Line& line) {
    if (std::isnan(line.baseline) && std::isnan(line.current)) return "";
    const std::string before = value_text(line.baseline, line.time), now = value_text(line.current, line.time);
    return fmt::format("{} -> {}{}{}", before, now, line.unit.empty() ? "" : " ", line.unit);
}

std::string change_text(const Line& line) {
    if (line.ratio == 0.0) return line.reason;
    std::string text = fmt::format("x{:.3f} [{:.3f}, {:.3f}]", line.ratio, line.interval.low, line.interval.high);
    return line.reason.empty() ? text : text + "; " + line.reason;
}

std::string front_text(const FrontChange& change) {
    Line line;
    line.suite = change.suite;
    line.group = change.group;
    line.cell = change.cell;
    std::string text = fmt::format("{} {}{} the front of {}", title_of(line), change.perhaps ? "perhaps " : "",
                                   change.joined ? "joined" : "left", change.front);
    for (std::size_t i = 0; i < change.by.size(); ++i)
        text += (i > 0 ? ", " : change.joined ? "; until now beaten by " : "; now beaten by ") + change.by[i];
    return text;
}

std::string counts_text(const Comparison& comparison) {
    std::map<std::pair<int, std::string>, int> counts;
    for (const Line& line : comparison.lines) ++counts[{severity(line.verdict), to_string(line.verdict)}];
    std::string text;
    for (const auto& [verdict, count] : counts)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", verdict.second, count);
    return text.empty() ? "nothing to compare" : text;
}

std::string outcome_text(const Comparison& comparison) {
    const int code = exit_code(comparison);
    if (code == 0 && comparison.enough > 0)
        return "exit code 0: nothing is larger or less accurate; too few processes to call a time slower";
    if (code == 0) return "exit code 0: nothing is slower, larger or less accurate";
    if (code == 1) return "exit code 1: slower";
    bool worse = false;
    for (const Line& line : comparison.lines)
        worse = worse || line.verdict == Verdict::larger || line.verdict == Verdict::less_accurate;
    return worse ? "exit code 2: larger or less accurate" : "exit code 2: missing or not comparable";
}

bool is_news(const Line& line) {
    if (line.verdict == Verdict::same) return false;
    if (line.verdict == Verdict::inconclusive) return line.suspicious || line.reason.rfind("look", 0) == 0;
    return true;
}

std::vector<const Line*> by_severity(const Comparison& comparison) {
    std::vector<const Line*> lines;
    for (const Line& line : comparison.lines) lines.push_back(&line);
    std::stable_sort(lines.begin(), lines.end(),
                     [](const Line* a, const Line* b) { return severity(a->verdict) < severity(b->verdict); });
    return lines;
}

std::string sensitivity(const Comparison& comparison) {
    const std::size_t enough = std::max(comparison.enough, fewest_processes);
    std::vector<std::pair<double, const Line*>> widths;
    std::vector<double> called;
    for (const Line& line : comparison.lines) {
        if (!line.time || line.fresh || !(line.ratio > 0.0) || line.processes < enough) continue;
        const double width = line.ratio / line.interval.low;
        const double blocks = comparison.interleaved ? 0.0 : line.unit == over_floor ? block_noise : plain_block_noise;
        widths.emplace_back(width, &line);
        called.push_back(width * (1.0 + comparison.options.effect + blocks));
    }
    if (widths.empty()) return "";
    std::sort(widths.begin(), widths.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::sort(called.begin(), called.end());
    const auto& [noisiest, noisiest_line] = widths.back();
    return fmt::format(
        "smallest slowdown detected: {} at the quietest time, {} at the median, {} at the noisiest ({}, {}); "
        "smallest called slower, beyond the minimum effect: {}, {} and {}",
        percent(widths.front().first), percent(widths[widths.size() / 2].first), percent(noisiest),
        title_of(*noisiest_line), noisiest_line->measure, percent(called.front()), percent(called[called.size() / 2]),
        percent(called.back()));
}

}  // namespace shadowbench::compare
