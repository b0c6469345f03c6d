#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "compare/judge.h"
#include "metrics/pareto.h"

namespace shadowbench::compare {
namespace {

using metrics::CostAndError;
using metrics::OnFront;

constexpr double absent = std::numeric_limits<double>::infinity();

double exact_of(const Cell* cell, const char* name) {
    if (!cell || cell->failed) return absent;
    for (const Exact& exact : cell->exact)
        if (exact.name == name) return exact.value;
    return absent;
}

// The plain time of lookups in random order, as in the fronts of a result.
double time_of(const Cell* cell) {
    if (!cell || cell->failed) return absent;
    for (const Timed& timed : cell->timed) {
        if (timed.name != "lookup_random") continue;
        std::vector<double> values;
        for (const Process& process : timed.processes) values.push_back(metrics::median(process.raw));
        return metrics::median(values);
    }
    return absent;
}

// What the intervals of the cell's own result say; absent if nothing is known.
std::optional<OnFront> mark_of(const Cell* cell, bool of_time) {
    if (!cell) return {};
    return of_time ? cell->on_time_front : cell->on_bytes_front;
}

using Lines = std::map<std::string, const Line*>;  // by cell and measure

const Line* find(const Lines& lines, const std::string& cell, const char* measure) {
    const auto found = lines.find(cell + '\n' + measure);
    return found == lines.end() ? nullptr : found->second;
}

// The current value, or the baseline's if the measure did not change.
double settled(double baseline, double current, const Line* line) {
    return line && baseline != absent && current != absent && line->verdict == Verdict::same ? baseline : current;
}

double settled_time(double baseline, double current, const Line* line) {
    if (baseline == absent || current == absent) return current;
    const bool changed = line && (line->verdict == Verdict::slower || line->verdict == Verdict::faster);
    return changed ? baseline * line->ratio : baseline;
}

struct Side {
    std::vector<CostAndError> choices;
    std::vector<bool> front;
};

const std::string& name_of(const FrontCell& cell) {
    return (cell.current ? cell.current : cell.baseline)->name;
}

std::vector<std::string> names_of_better(const Side& side, const std::vector<FrontCell>& cells, std::size_t i) {
    std::vector<std::string> names;
    const CostAndError& own = side.choices[i];
    if (own.cost == absent || own.error == absent) return names;  // it did not exist, or broke a promise
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const CostAndError& other = side.choices[k];
        if (side.front[k] && other.cost <= own.cost && other.error <= own.error &&
            (other.cost < own.cost || other.error < own.error))
            names.push_back(name_of(cells[k]));
    }
    return names;
}

}  // namespace

std::vector<FrontChange> front_changes(const std::string& suite, const std::string& group,
                                       const std::vector<FrontCell>& cells, const std::vector<Line>& lines,
                                       bool times_compare) {
    Lines by_name;
    for (const Line& line : lines)
        if (line.suite == suite && line.group == group) by_name[line.cell + '\n' + line.measure] = &line;
    // One side may be faster as a whole, so times of new cells are scaled to the baseline.
    std::vector<double> scales;
    for (const FrontCell& cell : cells) {
        const double before = time_of(cell.baseline), now = time_of(cell.current);
        if (before != absent && now != absent && now > 0.0) scales.push_back(before / now);
    }
    const double scale = scales.empty() ? 1.0 : metrics::median(scales);

    std::vector<FrontChange> changes;
    for (const bool of_time : {true, false}) {
        if (of_time && !times_compare) continue;
        Side before, now;
        for (const FrontCell& cell : cells) {
            const char* const error = "lookup_error.rms";
            const std::string& name = name_of(cell);
            const double error_before = exact_of(cell.baseline, error);
            const double error_now = settled(error_before, exact_of(cell.current, error), find(by_name, name, error));
            if (of_time) {
                const double time_before = time_of(cell.baseline);
                const double time_now = time_of(cell.current) * (cell.baseline ? 1.0 : scale);
                before.choices.push_back({time_before, error_before});
                now.choices.push_back(
                    {settled_time(time_before, time_now, find(by_name, name, "lookup_random")), error_now});
            } else {
                before.choices.push_back({exact_of(cell.baseline, "bytes"), error_before});
                now.choices.push_back(
                    {settled(before.choices.back().cost, exact_of(cell.current, "bytes"), find(by_name, name, "bytes")),
                     error_now});
            }
        }
        before.front = metrics::pareto_front(before.choices);
        now.front = metrics::pareto_front(now.choices);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (before.front[i] == now.front[i]) continue;
            const std::optional<OnFront> mark = mark_of(cells[i].current, of_time);
            if (mark == (now.front[i] ? OnFront::no : OnFront::certainly)) continue;
            changes.push_back({suite, group, name_of(cells[i]), of_time ? "time and error" : "bytes and error",
                               now.front[i], mark == OnFront::perhaps,
                               names_of_better(now.front[i] ? before : now, cells, i)});
        }
    }
    return changes;
}

}  // namespace shadowbench::compare
