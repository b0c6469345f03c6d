#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/table.h"
#include "recommend/answer.h"
#include "recommend/request.h"
#include "results/settled.h"

namespace shadowbench::recommend {

const char* to_string(Held held) {
    switch (held) {
        case Held::rays:
            return "rays too few";
        case Held::representation:
            return "the representation's own limit";
        case Held::bias:
            return "bias or the filter";
        case Held::budget:
            return "the budget ended";
        case Held::dear:
            return "already dearer";
        case Held::given:
            return "by these settings";
        case Held::at_most:
            return "over --at-most";
    }
    return "";
}

namespace {

constexpr const char* time_units[] = {"ns", "µs", "ms", "s"};

}  // namespace

std::string cost_text(double value, std::size_t cost) {
    if (static_cast<Cost>(cost) == Cost::bytes) return base::bytes_text(static_cast<std::size_t>(std::llround(value)));
    const bool lookup = static_cast<Cost>(cost) == Cost::lookup;
    std::size_t unit = lookup ? 0 : 2;
    for (; value >= 999.5 && unit + 1 < std::size(time_units); ++unit) value /= 1000.0;
    if (value >= 999.5) return fmt::format("{:.0f} {}", value, time_units[unit]);
    return fmt::format("{:.3g} {}", value, time_units[unit]);
}

double longer_budget(double seconds) {
    return std::max(usual_budget, 60.0 * std::ceil(2.0 * seconds / 60.0));
}

std::string budget_text(double seconds) {
    return std::fmod(seconds, 60.0) == 0.0 ? fmt::format("{}min", seconds / 60.0) : fmt::format("{:.6g}s", seconds);
}

namespace {

std::string error_with_interval(const Choice& choice) {
    if (!choice.confirmed) return fmt::format("about {:.3g}, not confirmed", choice.error.high);
    return fmt::format("{:.3g} to {:.3g}", choice.error.low, choice.error.high);
}

constexpr std::size_t least_width = 60;
constexpr std::size_t label_width = 7;  // of lines that begin with a cost

// Build times include those of capturing the light rays, which the table of a run has on a line of its own.
std::string named_cost(double value, std::size_t cost) {
    return cost_text(value, cost) + (static_cast<Cost>(cost) == Cost::build ? " with capture" : "");
}

// How much a cost is of another: a share up to twice as much, a ratio above.
std::string distance_text(double behind) {
    if (behind < 0.0) return fmt::format("{:.0f} % less:", -100.0 * behind);
    if (behind < 1.0) return fmt::format("{:.0f} % more:", 100.0 * behind);
    const double ratio = 1.0 + behind;
    return fmt::format("{:.{}f} x as much:", ratio, ratio < 10.0 ? 1 : 0);
}

std::string cut(std::string line, std::size_t width) {
    if (line.size() <= width) return line;
    line.resize(width - 3);
    return line + "...";
}

// What one may paste is never broken. What is whole goes on in further lines rather than being cut.
struct TextLine {
    std::string text;
    bool label = false, paste = false, whole = false;
};

// What does not fit goes on in the next line, behind the label.
std::string folded(const TextLine& line, std::size_t width) {
    if (line.paste) return line.text + "\n";
    if (!line.label) return base::wrapped(line.text, width);
    std::string text = base::wrapped(std::string(label_width, ' ') + line.text.substr(label_width), width);
    return text.replace(0, label_width, line.text, 0, label_width);
}

std::string folded(const std::vector<TextLine>& lines, std::size_t width) {
    std::string text;
    for (const TextLine& line : lines) text += folded(line, width);
    return text;
}

std::size_t lines_in(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

// Names joined to a line, as many as fit, but at least one.
std::string joined(const std::string& start, const std::vector<std::string>& names, std::size_t width) {
    std::string line = start;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::string next = (i == 0 ? " " : ", ") + names[i];
        const std::size_t left = names.size() - i;
        const std::string rest = fmt::format(" and {} more", left);
        if (i > 0 && line.size() + next.size() + (left > 1 ? rest.size() : 0) > width) return line + rest;
        line += next;
    }
    return line;
}

void add_cheapest(const Cheapest& cheapest, std::size_t k, const std::vector<Family>& families,
                  std::vector<TextLine>& lines) {
    const Choice& best = cheapest.best;
    lines.push_back(
        {fmt::format("{:<6} {}: {}", cost_words[k], named_cost(best.cost[k], k), setting_text(families, best.point)),
         true, false, true});
    std::string others;
    for (std::size_t other = 0; other < costs; ++other)
        if (other != k) others += fmt::format(", {} {}", cost_words[other], named_cost(best.cost[other], other));
    lines.push_back({fmt::format("       error {}{}", error_with_interval(best), others)});
    if (const auto& second = cheapest.runner_up) {
        const std::string distance = cheapest.tie ? "a tie with" : distance_text(cheapest.behind);
        lines.push_back(
            {fmt::format("       {} {}, {}{}", distance, cost_text(second->cost[k], k),
                         setting_text(families, second->point), second->confirmed ? "" : " (not confirmed)"),
             false, false, true});
    }
    if (const auto& perhaps = cheapest.perhaps)
        lines.push_back({fmt::format("       perhaps {}, error not confirmed: {}", cost_text(perhaps->cost[k], k),
                                     setting_text(families, perhaps->point)),
                         false, false, true});
}

std::vector<TextLine> held_lines(const Answer& answer, std::size_t width) {
    std::vector<TextLine> lines;
    for (const Held held :
         {Held::rays, Held::representation, Held::bias, Held::dear, Held::budget, Held::given, Held::at_most}) {
        std::vector<std::string> names;
        for (const Missed& missed : answer.missed)
            if (missed.held == held)
                names.push_back(missed.closest
                                    ? fmt::format("{} ({:.3g})", missed.technique, missed.closest->error.high)
                                    : missed.technique + " (not measured)");
        if (!names.empty()) lines.push_back({joined(fmt::format("not reached, {}:", to_string(held)), names, width)});
    }
    return lines;
}

// The answer begins with this: what follows is hardly the cheapest.
void add_warning(const Answer& answer, const Wording& wording, std::vector<TextLine>& lines) {
    const double longer = longer_budget(answer.budget);
    const std::string command = wording.again ? wording.again(longer) : "";
    lines.push_back({fmt::format("THE BUDGET WAS TOO SHORT: {} ended before {} of {} techniques were followed to the "
                                 "error, so cheaper settings are likely. {}",
                                 budget_text(answer.budget), answer.open, answer.techniques,
                                 command.empty() ? fmt::format("Give {} or more.", budget_text(longer))
                                                 : "What was measured is kept; go on with:"),
                     false, false, true});
    if (!command.empty()) lines.push_back({command, false, true});
}

std::string budget_line(const Answer& answer) {
    if (!answer.next) return "the budget ended first: a cheaper setting may be left";
    return fmt::format(
        "the budget ended first: the next step takes about {}, confirming included, and {} were left; a "
        "cheaper setting may be left",
        cost_text(1e3 * answer.next->seconds, static_cast<std::size_t>(Cost::build)),
        cost_text(1e3 * answer.next->left, static_cast<std::size_t>(Cost::build)));
}

std::string broken_line(const Answer& answer, std::size_t width) {
    std::vector<std::string> names;
    for (const Broken& broken : answer.broken)
        names.push_back(broken.settings == broken.measured
                            ? fmt::format("{} ({})", broken.technique, broken.reason)
                            : fmt::format("{} (at {} of {} settings: {})", broken.technique, broken.settings,
                                          broken.measured, broken.reason));
    return joined("failed and left out:", names, width);
}

}  // namespace

std::string setting_text(const std::vector<Family>& families, const Point& point) {
    const Family& family = families[point.family];
    std::string text = family.name;
    for (std::size_t i = 2; i < family.axes.size(); ++i)
        text +=
            fmt::format(" {}={}", family.axes[i].name, family.axes[i].values[static_cast<std::size_t>(point.step[i])]);
    std::string rays;
    for (std::size_t i = 0; i < 2; ++i)
        if (family.axes[i].steps() > 1 || !family.axes[i].values[0].empty())
            rays += fmt::format(" {}={}", family.axes[i].name,
                                family.axes[i].values[static_cast<std::size_t>(point.step[i])]);
    return rays.empty() ? text : text + "," + rays;
}

std::string to_text(const Answer& answer, const std::vector<Family>& families, const Wording& wording) {
    const std::size_t width = std::max(wording.width, least_width);
    std::vector<TextLine> lines;
    if (answer.too_early()) add_warning(answer, wording, lines);
    lines.push_back({fmt::format("{} error at most {:.4g} with 95 % confidence: {} settings measured, {} confirmed",
                                 wording.measure, answer.goal.error, answer.measured, answer.confirmed)});
    if (wording.truth && *wording.truth > 0.0)
        lines.push_back(
            {fmt::format("errors are against this scenario's truth (standard error {:.2g}); their lower ends "
                         "allow for it",
                         *wording.truth)});
    std::vector<std::string> pasted;
    for (std::size_t k = 0; k < costs; ++k) {
        if (!answer.cheapest[k]) continue;
        add_cheapest(*answer.cheapest[k], k, families, lines);
        if (!wording.paste) continue;
        const std::string line = wording.paste(answer.cheapest[k]->best.point);
        if (std::find(pasted.begin(), pasted.end(), line) == pasted.end()) pasted.push_back(line);
    }
    if (const auto& traced = answer.without_map)
        lines.push_back({fmt::format("without a map: {}, {}, error {}", setting_text(families, traced->point),
                                     cost_text(traced->cost[0], 0), error_with_interval(*traced)),
                         false, false, true});
    if (!answer.reached) {
        lines.push_back({answer.measured > 0 ? "no setting reaches it" : "nothing was measured, so nothing is known"});
        if (answer.closest)
            lines.push_back({fmt::format("closest: error {}: {}", error_with_interval(*answer.closest),
                                         setting_text(families, answer.closest->point)),
                             false, false, true});
    }
    std::vector<TextLine> last;
    for (std::string& line : pasted) last.push_back({std::move(line), false, true});
    if (!answer.broken.empty()) last.push_back({broken_line(answer, width)});
    if (answer.cut) last.push_back({"the time to confirm ran out: intervals are wider than planned"});
    if (answer.steal && *answer.steal > results::steal_limit)
        last.push_back(
            {fmt::format("UNSETTLED: the host of this virtual machine took {:.0f} % of the time (steal); "
                         "measure again",
                         100.0 * *answer.steal)});
    if (answer.end == End::budget) last.push_back({budget_line(answer), false, false, true});
    if (answer.end == End::cancelled) last.push_back({"cancelled: a cheaper setting may be left"});

    const std::string head = folded(lines, width), tail = folded(last, width);
    if (const std::string text = head + folded(held_lines(answer, width), width) + tail;
        lines_in(text) <= text_lines || width < text_columns)
        return text;
    // Reasons give way to the answer.
    std::vector<std::string> names;
    for (const Missed& missed : answer.missed) names.push_back(missed.technique);
    const TextLine missed{names.empty() ? "" : joined("not reached:", names, width)};
    if (const std::string text = head + (names.empty() ? "" : folded(missed, width)) + tail;
        lines_in(text) <= text_lines)
        return text;
    if (!names.empty()) lines.push_back(missed);
    lines.insert(lines.end(), last.begin(), last.end());
    for (TextLine& line : lines)
        if (!line.paste && !line.whole) line.text = cut(std::move(line.text), width);
    return folded(lines, width);
}

}  // namespace shadowbench::recommend
