#include <algorithm>

#include <fmt/format.h>

#include "base/markdown.h"
#include "claims/report.h"

namespace shadowbench::claims {
namespace {

constexpr const char* rules =
    "Every number is measured with the scenarios and on the machine named below. Absolute times cannot be compared "
    "between machines, so times are given as ratios within one run. *holds*: the paper's value is met (a ratio within "
    "a factor of 1.5), or bettered if the paper claims a gain. *holds in shape*: only the direction or the law is the "
    "paper's. *does not hold here*: neither. *undecided*: measured, but not judged; the last column says why. "
    "Intervals in brackets are 95 % intervals; the verdict is then the worst of those of the value and of both ends.\n";

std::string text_of(Verdict verdict) {
    const bool strong = verdict == Verdict::holds || verdict == Verdict::fails;
    return fmt::format("{0}{1}{0}", strong ? "**" : "", to_string(verdict));
}

void add_paper(std::string& out, const PaperReport& report) {
    out += fmt::format("## {}\n\n{}\n\n", report.title, report.conditions);
    std::vector<std::vector<std::string>> rows;
    for (const Claim& claim : report.claims)
        rows.push_back({claim.place, claim.says, claim.measured, text_of(claim.verdict), claim.why});
    out += base::markdown_table({"where", "the paper says", "measured here", "verdict", "why"}, rows);
    for (const Table& table : report.tables) {
        out += fmt::format("### {}\n\n", table.title);
        out += base::markdown_table(table.header, table.rows);
    }
    for (const Plot& plot : report.plots) out += fmt::format("![{}](plots/{}.svg)\n\n", plot.title, plot.name);
    for (const Sheet& sheet : report.sheets)
        out += fmt::format(
            "![{0}](pictures/{1}.png)\n\nAbove the pictures, from left to right: {0}. Below: the reference's "
            "visibility, then each difference from the reference, times four.\n\n",
            sheet.caption, sheet.name);
    out += fmt::format("Scenarios (name, hash): {}. Measured in {:.0f} s.\n\n", fmt::join(report.documents, ", "),
                       report.seconds);
}

}  // namespace

std::string to_markdown(std::span<const PaperReport> reports, const Conditions& conditions) {
    std::string out = "# Claims of the papers, measured again\n\n";
    if (conditions.quick) out += "**Quick run: smaller sizes than the report that is cited.**\n\n";
    out += rules;
    out += fmt::format("\n{}; {}; {}.\n\n", conditions.machine, conditions.build, conditions.date);
    std::size_t count[4] = {0, 0, 0, 0};
    for (const PaperReport& report : reports)
        for (const Claim& claim : report.claims) ++count[static_cast<int>(claim.verdict)];
    out += fmt::format("{} claims hold, {} hold in shape, {} do not hold here, {} are undecided.\n\n", count[0],
                       count[1], count[2], count[3]);
    for (const PaperReport& report : reports) add_paper(out, report);
    return out;
}

}  // namespace shadowbench::claims
