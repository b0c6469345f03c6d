#include <algorithm>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/table.h"
#include "compare/report.h"
#include "compare/words.h"

namespace shadowbench::compare {
namespace {

constexpr const char* rerun_label = "  rerun: ";

// The lines of one cell.
struct Block {
    std::string title, command;
    std::vector<const Line*> lines;
};

std::vector<Block> blocks_of(const Comparison& comparison, bool all) {
    std::vector<Block> blocks;
    std::map<std::string, std::size_t> places;
    for (const Line* line : by_severity(comparison)) {
        if (!all && !is_news(*line)) continue;
        const std::string title = title_of(*line);
        const auto [place, is_new] = places.emplace(title, blocks.size());
        if (is_new) blocks.push_back({title, line->rerun.source.empty() ? "" : command_of(line->rerun), {}});
        blocks[place->second].lines.push_back(line);
    }
    return blocks;
}

std::string text_of(const Block& block) {
    std::size_t measures = 0, values = 0;
    for (const Line* line : block.lines) {
        measures = std::max(measures, line->measure.size());
        values = std::max(values, values_text(*line).size());
    }
    std::string text = block.title + "\n";
    for (const Line* line : block.lines) {
        const std::string row = fmt::format("  {:<14}  {:<{}}  {:<{}}  {}", to_string(line->verdict), line->measure,
                                            measures, values_text(*line), values, change_text(*line));
        text += row.substr(0, row.find_last_not_of(' ') + 1) + "\n";
    }
    if (!block.command.empty()) text += rerun_label + block.command + "\n";
    return text;
}

// The inconclusive times that are not listed, counted by reason.
std::string folded(const Comparison& comparison) {
    std::map<std::string, int> counts;
    for (const Line& line : comparison.lines)
        if (line.verdict == Verdict::inconclusive && !is_news(line)) ++counts[line.reason];
    std::string text;
    for (const auto& [reason, count] : counts)
        text += fmt::format("inconclusive: {} time{}: {} (--all lists them)\n", count, count == 1 ? "" : "s", reason);
    return text;
}

// In lines of this width. Commands are not broken, so that they can be copied.
std::string fitted(const std::string& text, std::size_t width) {
    std::string result;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        result += line.starts_with(rerun_label) ? line + "\n" : base::wrapped(line, width);
    return result;
}

}  // namespace

std::string to_text(const Comparison& comparison, bool all, std::size_t width) {
    std::string text = fmt::format("{} -> {}\n{}\n", comparison.baseline, comparison.current, method(comparison));
    for (const std::string& note : comparison.notes) text += "note: " + note + "\n";
    for (const Block& block : blocks_of(comparison, all)) text += text_of(block);
    if (!all) text += folded(comparison);
    for (const FrontChange& change : comparison.fronts) text += front_text(change) + "\n";
    if (const std::string limits = sensitivity(comparison); !limits.empty()) text += limits + "\n";
    return fitted(text + fmt::format("{}; {}\n", counts_text(comparison), outcome_text(comparison)), width);
}

}  // namespace shadowbench::compare
