#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/table.h"
#include "recommend/answer.h"
#include "recommend/request.h"
#include "results/settled.h"

namespace shadowbench::recommend {

std::string cost_text(double value, std::size_t cost) {
    if (static_cast<Cost>(cost) == Cost::bytes) return base::bytes_text(static_cast<std::size_t>(std::llround(value)));
    return fmt::format("{:.3g} {}", value, static_cast<Cost>(cost) == Cost::lookup ? "ns" : "ms");
}

namespace {

std::string error_with_interval(const Choice& choice) {
    if (!choice.confirmed) return fmt::format("about {:.3g}, not confirmed", choice.error.high);
    return fmt::format("{:.3g} to {:.3g}", choice.error.low, choice.error.high);
}

std::string cut(std::string line) {
    if (line.size() <= text_columns) return line;
    line.resize(text_columns - 3);
    return line + "...";
}

// Names joined to a line of at most text_columns, as many as fit.
std::string joined(const std::string& start, const std::vector<std::string>& names) {
    std::string line = start;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::string next = (i == 0 ? " " : ", ") + names[i];
        const std::size_t left = names.size() - i;
        const std::string rest = fmt::format(" and {} more", left);
        if (i > 0 && line.size() + next.size() + (left > 1 ? rest.size() : 0) > text_columns) return cut(line + rest);
        line += next;
    }
    return cut(line);
}

const char* held_text(Held held) {
    switch (held) {
        case Held::rays: return "rays too few";
        case Held::representation: return "the representation's own limit";
        case Held::bias: return "bias or the filter";
        case Held::budget: return "the budget ended";
        case Held::dear: return "already dearer";
        case Held::given: return "by these settings";
        case Held::at_most: return "over --at-most";
    }
    return "";
}

void add_cheapest(const Cheapest& cheapest, std::size_t k, const std::vector<Family>& families,
                  std::vector<std::string>& lines) {
    const Choice& best = cheapest.best;
    lines.push_back(cut(fmt::format("{:<6} {}: {}", cost_words[k], cost_text(best.cost[k], k),
                                    setting_text(families, best.point))));
    std::string others;
    for (std::size_t other = 0; other < costs; ++other)
        if (other != k) others += fmt::format(", {} {}", cost_words[other], cost_text(best.cost[other], other));
    lines.push_back(cut(fmt::format("       error {}{}", error_with_interval(best), others)));
    if (const auto& second = cheapest.runner_up) {
        const std::string distance = cheapest.tie             ? "a tie with"
                                     : cheapest.behind >= 0.0 ? fmt::format("{:.0f} % more:", 100.0 * cheapest.behind)
                                                              : fmt::format("{:.0f} % less:", -100.0 * cheapest.behind);
        lines.push_back(cut(fmt::format("       {} {}, {}{}", distance, cost_text(second->cost[k], k),
                                        setting_text(families, second->point),
                                        second->confirmed ? "" : " (not confirmed)")));
    }
    if (const auto& perhaps = cheapest.perhaps)
        lines.push_back(cut(fmt::format("       perhaps {}, error not confirmed: {}", cost_text(perhaps->cost[k], k),
                                        setting_text(families, perhaps->point))));
}

std::vector<std::string> held_lines(const Answer& answer) {
    std::vector<std::string> lines;
    for (const Held held : {Held::rays, Held::representation, Held::bias, Held::dear, Held::budget, Held::given, Held::at_most}) {
        std::vector<std::string> names;
        for (const Missed& missed : answer.missed)
            if (missed.held == held)
                names.push_back(missed.closest ? fmt::format("{} ({:.3g})", missed.technique, missed.closest->error.high)
                                               : missed.technique + " (not measured)");
        if (!names.empty()) lines.push_back(joined(fmt::format("not reached, {}:", held_text(held)), names));
    }
    return lines;
}

std::string broken_line(const Answer& answer) {
    std::vector<std::string> names;
    for (const Broken& broken : answer.broken)
        names.push_back(broken.settings == broken.measured
                            ? fmt::format("{} ({})", broken.technique, broken.reason)
                            : fmt::format("{} (at {} of {} settings: {})", broken.technique, broken.settings,
                                          broken.measured, broken.reason));
    return joined("failed and left out:", names);
}

}  // namespace

std::string setting_text(const std::vector<Family>& families, const Point& point) {
    const Family& family = families[point.family];
    std::string text = family.name;
    for (std::size_t i = 2; i < family.axes.size(); ++i)
        text += fmt::format(" {}={}", family.axes[i].name, family.axes[i].values[static_cast<std::size_t>(point.step[i])]);
    std::string rays;
    for (std::size_t i = 0; i < 2; ++i)
        if (family.axes[i].steps() > 1 || !family.axes[i].values[0].empty())
            rays += fmt::format(" {}={}", family.axes[i].name,
                                family.axes[i].values[static_cast<std::size_t>(point.step[i])]);
    return rays.empty() ? text : text + "," + rays;
}

std::string to_text(const Answer& answer, const std::vector<Family>& families, const Wording& wording) {
    std::vector<std::string> lines;
    lines.push_back(cut(fmt::format("{} error at most {:.4g} with 95 % confidence: {} settings measured, {} confirmed",
                                    wording.measure, answer.goal.error, answer.measured, answer.confirmed)));
    std::vector<std::string> pasted;
    for (std::size_t k = 0; k < costs; ++k) {
        if (!answer.cheapest[k]) continue;
        add_cheapest(*answer.cheapest[k], k, families, lines);
        if (!wording.paste) continue;
        const std::string line = wording.paste(answer.cheapest[k]->best.point);
        if (std::find(pasted.begin(), pasted.end(), line) == pasted.end()) pasted.push_back(line);
    }
    if (const auto& traced = answer.without_map)
        lines.push_back(cut(fmt::format("without a map: {}, {}, error {}", setting_text(families, traced->point),
                                        cost_text(traced->cost[0], 0), error_with_interval(*traced))));
    if (!answer.reached) {
        lines.push_back("no setting reaches it");
        if (answer.closest)
            lines.push_back(cut(fmt::format("closest: error {}: {}", error_with_interval(*answer.closest),
                                            setting_text(families, answer.closest->point))));
    }
    std::vector<std::string> last = pasted;
    if (!answer.broken.empty()) last.push_back(broken_line(answer));
    if (answer.cut) last.push_back("the time to confirm ran out: intervals are wider than planned");
    if (answer.steal && *answer.steal > results::steal_limit)
        last.push_back(fmt::format("UNSETTLED: the host of this virtual machine took {:.0f} % of the time (steal); measure again",
                                   100.0 * *answer.steal));
    if (answer.end == End::budget) last.push_back("the budget ended first: a cheaper setting may be left");
    if (answer.end == End::cancelled) last.push_back("cancelled: a cheaper setting may be left");
    std::vector<std::string> held = held_lines(answer);
    if (lines.size() + held.size() + last.size() > text_lines) {
        // Reasons give way to the answer.
        held.clear();
        std::vector<std::string> names;
        for (const Missed& missed : answer.missed) names.push_back(missed.technique);
        held.push_back(joined("not reached:", names));
    }
    lines.insert(lines.end(), held.begin(), held.end());
    lines.insert(lines.end(), last.begin(), last.end());
    return fmt::format("{}\n", fmt::join(lines, "\n"));
}

}  // namespace shadowbench::recommend
