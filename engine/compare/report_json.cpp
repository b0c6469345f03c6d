#include <cmath>

#include <nlohmann/json.hpp>

#include "compare/report.h"
#include "compare/words.h"

namespace shadowbench::compare {
namespace {

using nlohmann::ordered_json;

ordered_json number(double value) {
    return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json to_json(const Line& line, const Options& options) {
    ordered_json out{
        {"title", title_of(line)},
        {"suite", line.suite},
        {"group", line.group},
        {"cell", line.cell},
        {"measure", line.measure},
        {"verdict", to_string(line.verdict)},
        {"code", code_of(line, options)},
        {"unit", line.unit},
        {"baseline", number(line.baseline)},
        {"current", number(line.current)},
        {"reason", line.reason},
        {"command", line.rerun.source.empty() ? ordered_json(nullptr) : ordered_json(command_of(line.rerun))},
        {"time", nullptr}};
    if (line.ratio > 0.0)
        out["time"] = {
            {"ratio", number(line.ratio)}, {"interval95", {number(line.interval.low), number(line.interval.high)}},
            {"processes", line.processes}, {"p_slower", line.p_slower},
            {"p_faster", line.p_faster},   {"looks_slower", line.suspicious}};
    return out;
}

}  // namespace

ordered_json to_json(const Comparison& comparison) {
    ordered_json lines = ordered_json::array(), fronts = ordered_json::array(), counts = ordered_json::object();
    for (const Line* line : by_severity(comparison)) {
        lines.push_back(to_json(*line, comparison.options));
        ordered_json& count = counts[to_string(line->verdict)];
        count = count.is_null() ? 1 : count.get<int>() + 1;
    }
    for (const FrontChange& change : comparison.fronts)
        fronts.push_back({{"suite", change.suite},
                          {"group", change.group},
                          {"cell", change.cell},
                          {"front", change.front},
                          {"joined", change.joined},
                          {"perhaps", change.perhaps},
                          {"by", change.by},
                          {"text", front_text(change)}});
    return {{"schema_version", 1},
            {"baseline", comparison.baseline},
            {"current", comparison.current},
            {"exit_code", exit_code(comparison)},
            {"outcome", outcome_text(comparison)},
            {"interleaved", comparison.interleaved},
            {"effect", comparison.options.effect},
            {"judged_times", comparison.judged_times},
            {"method", method(comparison)},
            {"sensitivity", sensitivity(comparison)},
            {"counts", std::move(counts)},
            {"lines", std::move(lines)},
            {"fronts", std::move(fronts)},
            {"notes", comparison.notes}};
}

}  // namespace shadowbench::compare
