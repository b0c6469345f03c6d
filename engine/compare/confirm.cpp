#include <algorithm>

#include <fmt/format.h>

#include "compare/compare.h"

namespace shadowbench::compare {

std::vector<Line> suspicious(const Comparison& comparison) {
    std::vector<Line> lines;
    for (const Line& line : comparison.lines)
        if (line.suspicious && !line.rerun.source.empty()) lines.push_back(line);
    return lines;
}

namespace {

// Finds the same measure of the same cell by the cell's name, or else by its technique: a cell that runs alone is not
// swept, so its name lacks the swept values.
const Line* find_again(const Comparison& again, const Line& line) {
    const auto find = [&](const auto& same_cell) {
        const auto found = std::find_if(again.lines.begin(), again.lines.end(), [&](const Line& other) {
            return other.suite == line.suite && other.group == line.group && other.measure == line.measure &&
                   other.ratio > 0.0 && same_cell(other);
        });
        return found == again.lines.end() ? nullptr : &*found;
    };
    if (const Line* named = find([&](const Line& other) { return other.cell == line.cell; })) return named;
    if (line.rerun.technique.empty()) return nullptr;
    return find([&](const Line& other) { return other.rerun.technique == line.rerun.technique; });
}

}  // namespace

void confirm(Comparison& first, const Comparison& again) {
    for (Line& line : first.lines) {
        if (!line.suspicious) continue;
        const Line* const fresh = find_again(again, line);
        if (!fresh) {
            line.reason += (line.reason.empty() ? "" : "; ") + std::string("it was not run again");
            continue;
        }
        if (again.enough > fresh->processes) {
            line.reason +=
                fmt::format("{}{} fresh {} are too few to confirm it: {} are needed", line.reason.empty() ? "" : "; ",
                            fresh->processes, again.interleaved ? "pairs" : "processes", again.enough);
            continue;
        }
        const std::string what = fmt::format("{} fresh {}: x{:.3f} [{:.3f}, {:.3f}], x{:.3f} at first",
                                             fresh->processes, again.interleaved ? "pairs" : "processes", fresh->ratio,
                                             fresh->interval.low, fresh->interval.high, line.ratio);
        const bool confirmed = fresh->verdict == Verdict::slower;
        const Rerun rerun = line.rerun;
        const std::string cell = line.cell;
        line = *fresh;
        line.rerun = rerun;
        line.cell = cell;
        line.verdict = confirmed ? Verdict::slower : Verdict::inconclusive;
        line.suspicious = confirmed;
        line.fresh = true;
        line.reason = (confirmed ? "confirmed by " : "looked slower, not confirmed by ") + what;
    }
}

}  // namespace shadowbench::compare
