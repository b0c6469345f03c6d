#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/markdown.h"
#include "claims/former.h"
#include "claims/report.h"
#include "claims/words.h"
#include "results/settled.h"

namespace shadowbench::claims {
namespace {

constexpr const char* introduction =
    "Every number is measured with the scenarios and on the machine named below. Absolute times cannot be compared "
    "between machines, so claims are about ratios of times. Numbers in brackets are 95 % intervals; of a median of six "
    "values, their range, which holds it with 97 %. A number without brackets came out equal in all repetitions, or "
    "nothing was repeated, as for a largest value over all places:\n\n"
    "- Of a time: the number is the median over repetitions. Times of two tables are taken minutes apart, between "
    "which a machine may become slower or faster: only those of one table compare.\n"
    "- Of a ratio of times: the number is the median of the ratios of each repetition. What is compared takes turns, "
    "so that a machine that slows down slows both; where it does not, the claim says so. Repetitions go on until the "
    "interval is within 5 % of the ratio, or a limit of time is reached; where no single ratio is judged by its size, "
    "their number is fixed.\n"
    "- Of an error rms: the number is the error expected over seeds of the light rays against the exact truth. The "
    "truth is a mean of rays too; its noise is taken off. The interval covers the noise of both; if the light rays are "
    "regular, only that of the truth.\n"
    "- Of an exponent: the interval is that of the fit, or over seeds if each of them gives an exponent; the claim or "
    "the paper's introduction then says so.\n"
    "- Elsewhere, as for medians over scenes or means over places of the map, the paper's introduction or the title of "
    "the table says what the numbers are over.\n\n"
    "Each claim is judged by rules of the table below, by the whole interval of what is measured: *holds*, *holds in "
    "shape*, or *does not hold here*. If the interval crosses a limit of the rule, the claim is *undecided*; the best "
    "and the worst verdict that it may have stand behind. A claim about the size of a GPU's times, about numbers of a "
    "scene that is not public, or without a value is *not comparable*: its number is given, and nothing is judged, "
    "unless the claim says why it is judged nevertheless. "
    "What a technique cannot do otherwise is *by construction*.\n\n"
    "The parts of a claim are judged one by one, and the column of rules names the rules and limits of all. Of two "
    "halves (\"A fits, and is closer than B\") the worse verdict counts. *In all*: the worst verdict of all entries "
    "counts, but the claim holds in shape if it holds in more than half of them. *In most*: the verdict counts that "
    "more than half of the entries reach. *In any*: the claim is that such an entry can be found, and the best verdict "
    "of all counts. *In all readings*: the paper's words leave open what is compared, or in "
    "which arrangement; each reading is judged, and a verdict stands only if all readings have it. Else the claim is "
    "undecided. An undecided part may have any verdict from the best to the worst that its interval or its readings "
    "allow; where the claim's verdict is the same for all of these, it is decided.\n\n"
    "The captions of pictures give the rms and FLIP of each picture beside the reference, a picture of the truth: the "
    "rms in linear light over all pixels, FLIP as a display shows them. They are of one seed and have no interval, and "
    "no claim is judged by them. Where a claim compares pictures, its paper's introduction says how.\n";

constexpr const char* former_introduction =
    "The first report judged some claims *holds in shape* or *does not hold here*, by rules that differed from claim "
    "to claim.\n\n";

std::string quick_note(const std::string& beside) {
    const char* quick = "**Quick run: smaller sizes than the report that is cited.**";
    if (beside.empty())
        return fmt::format("{} There is no full report beside it: its verdicts are its own.\n\n", quick);
    return fmt::format("{} Where a verdict would not be that of {}, it is *undecided*.\n\n", quick, beside);
}

std::string rules_table() {
    std::vector<std::vector<std::string>> rows;
    for (const Rule& rule : all_rules()) rows.push_back({rule.id, rule.says, rule.holds, rule.in_shape, rule.reason});
    return base::markdown_table({"rule", "the paper says", "holds if", "holds in shape if", "reason"}, rows);
}

std::string words_table() {
    std::vector<std::vector<std::string>> rows;
    for (const Word& word : all_words()) rows.push_back({word.words, word.rules, word.note});
    return base::markdown_table({"the papers' words", "rule", "note"}, rows);
}

std::string rule_text(const Judged& judged) {
    return judged.limits.empty() ? judged.rule : judged.rule + ": " + judged.limits;
}

std::string text_of(const Judged& judged) {
    const Verdict verdict = judged.verdict;
    const bool strong = verdict == Verdict::holds || verdict == Verdict::fails;
    const std::string text = fmt::format("{0}{1}{0}", strong ? "**" : "", to_string(verdict));
    if (verdict != Verdict::undecided || judged.best == judged.worst) return text;
    return fmt::format("{} ({} to {})", text, to_string(judged.best), to_string(judged.worst));
}

void add_paper(std::string& out, const PaperReport& report) {
    out += fmt::format("## {}\n\n{}\n\n", report.title, report.conditions);
    std::vector<std::vector<std::string>> rows;
    for (const Claim& claim : report.claims)
        rows.push_back({claim.place, claim.says, claim.measured, rule_text(claim.judged), text_of(claim.judged),
                        claim.why});
    out += base::markdown_table({"where", "the paper says", "measured here", "rule", "verdict", "why"}, rows);
    for (const Table& table : report.tables) {
        out += fmt::format("### {}\n\n", table.title);
        out += base::markdown_table(table.header, table.rows);
    }
    for (const Plot& plot : report.plots) out += fmt::format("![{}](plots/{}.svg)\n\n", plot.title, plot.name);
    for (const Sheet& sheet : report.sheets)
        out += fmt::format("![{0}](pictures/{0}.png)\n\n{1}.\n\n", sheet.name, sheet.caption);
    out += fmt::format("Scenarios (name, hash): {}. Measured in {:.0f} s.\n\n", fmt::join(report.documents, ", "),
                       report.seconds);
}

}  // namespace

std::string steal_line(std::span<const PaperReport> reports) {
    double taken = 0.0, seconds = 0.0;
    std::vector<std::string> beyond;
    for (const PaperReport& report : reports) {
        if (!report.steal_seconds || report.seconds <= 0.0) continue;
        taken += *report.steal_seconds;
        seconds += report.seconds;
        const double share = *report.steal_seconds / report.seconds;
        if (share > results::steal_limit) beyond.push_back(fmt::format("{} ({:.1f} %)", report.id, 100.0 * share));
    }
    if (seconds <= 0.0) return "";
    const std::string text =
        fmt::format("The host of a virtual machine took {:.1f} % of the time (steal)", 100.0 * taken / seconds);
    const double limit = 100.0 * results::steal_limit;
    if (beyond.empty()) return fmt::format("{}, and at no paper more than {:.0f} %.", text, limit);
    return fmt::format("{}, and more than {:.0f} % at {}: measure again what is about times there.", text, limit,
                       fmt::join(beyond, ", "));
}

std::string to_markdown(std::span<const PaperReport> reports, const Conditions& conditions) {
    std::string out = "# Claims of the papers, measured again\n\n";
    if (conditions.quick) out += quick_note(conditions.beside);
    out += introduction;
    out += fmt::format("\n{}; {}; {}.\n\n", conditions.machine, conditions.build, conditions.date);
    if (const std::string steal = steal_line(reports); !steal.empty()) out += steal + "\n\n";
    std::array<std::size_t, verdicts> count{};
    std::size_t all = 0;
    for (const PaperReport& report : reports) {
        all += report.claims.size();
        for (const Claim& claim : report.claims) ++count[static_cast<std::size_t>(claim.judged.verdict)];
    }
    std::vector<std::string> parts;
    for (std::size_t verdict = 0; verdict < verdicts; ++verdict)
        parts.push_back(fmt::format("{} {}", to_string(static_cast<Verdict>(verdict)), count[verdict]));
    out += fmt::format("Of {} claims: {}.\n\n## Rules\n\n", all, fmt::join(parts, ", "));
    out += rules_table();
    out += "The same words are judged by the same rules in all papers:\n\n" + words_table();
    if (const std::string former = former_table(reports); !former.empty())
        out += fmt::format("## What became of the first verdicts\n\n{}{}", former_introduction, former);
    for (const PaperReport& report : reports) add_paper(out, report);
    return out;
}

}  // namespace shadowbench::claims
