#include "compare/compare.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "compare/judge.h"

namespace shadowbench::compare {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

using Name = std::pair<std::string, std::string>;  // group and name of a cell

struct Pair {
    const Suite* baseline = nullptr;  // null: extra
    const Suite* current = nullptr;   // null: missing
    std::string label;
};

// Pairs suites of equal name and hash first, then suites of equal name if each side has one of it unpaired: the
// scenario changed.
std::vector<Pair> match(const std::vector<Suite>& baseline, const std::vector<Suite>& current) {
    std::map<std::string, std::pair<int, int>> count;
    for (const Suite& suite : baseline) ++count[suite.name].first;
    for (const Suite& suite : current) ++count[suite.name].second;
    const auto label = [&](const Suite& suite) {
        const auto [before, now] = count[suite.name];
        return before > 1 || now > 1 ? fmt::format("{} [{}]", suite.name, suite.hash.substr(0, 8)) : suite.name;
    };
    std::vector<Pair> pairs;
    std::vector<const Suite*> unpaired;
    for (const Suite& suite : current) unpaired.push_back(&suite);
    const auto take = [&](const auto& fits) -> const Suite* {
        const auto found = std::find_if(unpaired.begin(), unpaired.end(), fits);
        if (found == unpaired.end()) return nullptr;
        const Suite* const suite = *found;
        unpaired.erase(found);
        return suite;
    };
    for (const Suite& suite : baseline)
        pairs.push_back(
            {&suite, take([&](const Suite* other) { return other->name == suite.name && other->hash == suite.hash; }),
             label(suite)});
    for (Pair& pair : pairs) {
        const std::string& name = pair.baseline->name;
        if (!pair.current && count[name] == std::pair(1, 1))
            pair.current = take([&](const Suite* other) { return other->name == name; });
    }
    for (const Suite* suite : unpaired) pairs.push_back({nullptr, suite, label(*suite)});
    return pairs;
}

Line line_of(const Pair& pair, const Cell* cell, Verdict verdict, std::string reason) {
    Line line;
    line.suite = pair.label;
    if (cell) {
        line.group = cell->group;
        line.cell = cell->name;
        line.rerun = cell->rerun;
    }
    line.baseline = line.current = none;
    line.verdict = verdict;
    line.reason = std::move(reason);
    return line;
}

const Exact* find(const std::vector<Exact>& measures, const std::string& name) {
    for (const Exact& exact : measures)
        if (exact.name == name) return &exact;
    return nullptr;
}

const Timed* find(const std::vector<Timed>& measures, const std::string& name) {
    for (const Timed& timed : measures)
        if (timed.name == name) return &timed;
    return nullptr;
}

// The factor by which work that does not change took longer on the current side.
double machine_of(const Pair& pair) {
    const std::vector<double>&before = pair.baseline->speed, &now = pair.current->speed;
    return before.empty() || now.empty() ? 1.0 : metrics::median(before) / metrics::median(now);
}

class Judge {
public:
    Judge(const Options& options, Comparison& comparison) : options_(options), comparison_(comparison) {}

    void suites(const Pair& pair);

private:
    void cells(const Pair& pair, const Cell& baseline, const Cell& current, bool times);
    void promises(const Pair& pair, const Cell& baseline, const Cell& current);
    void exact(const Pair& pair, const Cell& baseline, const Cell& current, bool one_machine);
    void times(const Pair& pair, const Cell& baseline, const Cell& current);
    void fronts(const Pair& pair, const std::map<Name, FrontCell>& all, bool times);
    void add(Line line) { comparison_.lines.push_back(std::move(line)); }

    const Options& options_;
    Comparison& comparison_;
};

void Judge::promises(const Pair& pair, const Cell& baseline, const Cell& current) {
    Line line = line_of(pair, &current, Verdict::same, "");
    line.measure = "promises";
    if (baseline.failed != current.failed) {
        line.verdict = current.failed ? Verdict::less_accurate : Verdict::more_accurate;
        line.reason =
            current.failed ? "broken now: " + current.failure : "kept now; broken before: " + baseline.failure;
    } else if (current.failed) {
        line.reason = "broken as before: " + current.failure;
    } else if (baseline.degraded != current.degraded) {
        line.verdict = current.degraded ? Verdict::less_accurate : Verdict::more_accurate;
        line.reason =
            current.degraded ? "degraded now: its error is above the noise of the rays" : "no longer degraded";
    }
    add(std::move(line));
}

void Judge::exact(const Pair& pair, const Cell& baseline, const Cell& current, bool one_machine) {
    for (const Exact& before : baseline.exact) {
        Line line = line_of(pair, &current, Verdict::missing, "not measured now");
        line.measure = before.name;
        line.baseline = before.value;
        if (const Exact* now = find(current.exact, before.name)) {
            line.reason.clear();
            line.verdict = Verdict::same;
            if (before.kind == Kind::instructions && !one_machine) {
                line.verdict = Verdict::not_comparable;
                line.time = true;
                line.reason = "another machine, whose libraries may run other code";
            } else {
                judge_exact(before, *now, options_, line);
            }
        }
        add(std::move(line));
    }
    for (const Exact& now : current.exact) {
        if (find(baseline.exact, now.name)) continue;
        Line line = line_of(pair, &current, Verdict::extra, "not measured before");
        line.measure = now.name;
        line.current = now.value;
        add(std::move(line));
    }
}

void Judge::times(const Pair& pair, const Cell& baseline, const Cell& current) {
    if (baseline.failed || current.failed) return;  // times of wrong answers are not compared
    for (const Timed& before : baseline.timed) {
        Line line = line_of(pair, &current, Verdict::missing, "not timed now");
        line.measure = before.name;
        line.time = true;
        if (const Timed* now = find(current.timed, before.name)) {
            line.reason.clear();
            line.verdict = Verdict::same;
            judge_time(before, *now, comparison_.interleaved, machine_of(pair), options_, line);
        }
        add(std::move(line));
    }
}

void Judge::cells(const Pair& pair, const Cell& baseline, const Cell& current, bool times_compare) {
    if (baseline.version != current.version) {
        add(line_of(pair, &current, Verdict::not_comparable,
                    fmt::format("version {} of the technique against {}", baseline.version, current.version)));
        return;
    }
    promises(pair, baseline, current);
    exact(pair, baseline, current, times_compare);
    if (times_compare) times(pair, baseline, current);
}

void Judge::fronts(const Pair& pair, const std::map<Name, FrontCell>& all, bool times_compare) {
    std::map<std::string, std::vector<FrontCell>> groups;
    for (const auto& [name, cell] : all) {
        const bool version_changed = cell.baseline && cell.current && cell.baseline->version != cell.current->version;
        if (!version_changed) groups[name.first].push_back(cell);
    }
    for (const auto& [group, cells] : groups) {
        std::vector<FrontChange> changes =
            front_changes(pair.label, group, cells, comparison_.lines, times_compare && !pair.baseline->hash.empty());
        std::move(changes.begin(), changes.end(), std::back_inserter(comparison_.fronts));
    }
}

void Judge::suites(const Pair& pair) {
    const auto count = [](const Suite& suite) {
        return fmt::format("{} cell{}", suite.cells.size(), suite.cells.size() == 1 ? "" : "s");
    };
    if (!pair.current) {
        add(line_of(pair, nullptr, Verdict::missing, count(*pair.baseline) + ", but no result now"));
        return;
    }
    if (!pair.baseline) {
        add(line_of(pair, nullptr, Verdict::extra, count(*pair.current) + ", but no result before"));
        return;
    }
    if (pair.baseline->hash != pair.current->hash) {
        std::string reason =
            fmt::format("the scenario changed (hash {} against {}", pair.baseline->hash, pair.current->hash);
        if (pair.baseline->seed != pair.current->seed)
            reason += fmt::format(", seed {} against {}", pair.baseline->seed, pair.current->seed);
        add(line_of(pair, nullptr, Verdict::not_comparable, reason + ")"));
        return;
    }
    const bool times_compare = pair.baseline->machine == pair.current->machine;
    if (!times_compare) {
        Line line =
            line_of(pair, nullptr, Verdict::not_comparable,
                    fmt::format("another machine: {} against {}", pair.baseline->machine, pair.current->machine));
        line.measure = "times";
        line.time = true;
        add(std::move(line));
    }
    std::map<Name, FrontCell> all;
    for (const Cell& cell : pair.current->cells) all[{cell.group, cell.name}].current = &cell;
    for (const Cell& cell : pair.baseline->cells) {
        FrontCell& both = all[{cell.group, cell.name}];
        both.baseline = &cell;
        if (both.current) {
            cells(pair, cell, *both.current, times_compare);
            continue;
        }
        const std::string& only = pair.current->only;
        const bool left_out =
            !only.empty() && (" " + only + " ").find(" " + cell.rerun.only + " ") == std::string::npos;
        add(line_of(pair, &cell, Verdict::missing,
                    left_out ? "the current result lacks this cell: that run was limited to " + only
                                                      : "the current result lacks this cell"));
    }
    for (const Cell& cell : pair.current->cells)
        if (!all[{cell.group, cell.name}].baseline) add(line_of(pair, &cell, Verdict::extra, "the baseline lacks this cell"));
    fronts(pair, all, times_compare);
}

}  // namespace

Comparison compare(const Measured& baseline, const Measured& current, const Options& options) {
    Comparison comparison;
    comparison.options = options;
    comparison.interleaved = !baseline.interleaved.empty() && baseline.interleaved == current.interleaved;
    if (comparison.interleaved && baseline.files != current.files) {
        comparison.interleaved = false;
        comparison.notes.push_back("not judged in pairs: the sides do not hold the same files");
    }
    for (const auto& [side, measured] : {std::pair("baseline", &baseline), std::pair("current", &current)})
        for (const std::string& note : measured->notes) comparison.notes.push_back(fmt::format("{}: {}", side, note));
    Judge judge(options, comparison);
    for (const Pair& pair : match(baseline.suites, current.suites)) judge.suites(pair);
    apply_holm(comparison);
    return comparison;
}

}  // namespace shadowbench::compare
