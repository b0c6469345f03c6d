#include <fmt/format.h>

#include "base/markdown.h"
#include "compare/report.h"
#include "compare/words.h"

namespace shadowbench::compare {
namespace {

using base::markdown_escaped;

// A bar ends a cell even inside code, so it is written as an entity.
std::string code(const std::string& text) {
    std::string result;
    for (const char c : text) switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '|':
                result += "&#124;";
                break;
            case '\n':
                result += ' ';
                break;
            default:
                result += c;
        }
    return "<code>" + result + "</code>";
}

}  // namespace

std::string to_markdown(const Comparison& comparison) {
    std::string text = fmt::format("## shadowbench: {}\n\n{} → {}: {}.\n\n", outcome_text(comparison),
                                   markdown_escaped(comparison.baseline), markdown_escaped(comparison.current),
                                   counts_text(comparison));
    std::string rows;
    for (const Line* line : by_severity(comparison))
        if (is_news(*line))
            rows += fmt::format("| {} | {} | {} | {} | {} | {} |\n", to_string(line->verdict),
                                markdown_escaped(title_of(*line)), markdown_escaped(line->measure),
                                markdown_escaped(values_text(*line)), markdown_escaped(change_text(*line)),
                                line->rerun.source.empty() ? "" : code(command_of(line->rerun)));
    if (!rows.empty())
        text += "| verdict | cell | measure | baseline → current | change | rerun |\n|---|---|---|---|---|---|\n" +
                rows + "\n";
    for (const FrontChange& change : comparison.fronts) text += "- " + markdown_escaped(front_text(change)) + "\n";
    for (const std::string& note : comparison.notes) text += "- " + markdown_escaped(note) + "\n";
    if (!comparison.fronts.empty() || !comparison.notes.empty()) text += "\n";
    text += method(comparison) + ".\n";
    if (const std::string limits = sensitivity(comparison); !limits.empty())
        text += "\n" + markdown_escaped(limits) + ".\n";
    return text;
}

}  // namespace shadowbench::compare
