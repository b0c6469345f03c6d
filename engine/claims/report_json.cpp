#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/write_files.h"
#include "claims/report.h"
#include "results/write_result.h"

namespace shadowbench::claims {
namespace {

using nlohmann::ordered_json;

ordered_json to_object(const Claim& claim) {
    ordered_json values = ordered_json::array();
    for (const Value& v : claim.values) values.push_back({{"value", v.value}, {"low", v.low}, {"high", v.high}});
    return {{"where", claim.place},
            {"says", claim.says},
            {"measured", claim.measured},
            {"values", values},
            {"rule", claim.judged.rule},
            {"limits", claim.judged.limits},
            {"verdict", to_string(claim.judged.verdict)},
            {"why", claim.why}};
}

ordered_json to_object(const Plot& plot) {
    ordered_json series = ordered_json::array();
    for (const Series& s : plot.series) series.push_back({{"name", s.name}, {"points", s.points}});
    return {{"name", plot.name},   {"title", plot.title}, {"x", plot.x_label}, {"y", plot.y_label},
            {"log_x", plot.log_x}, {"log_y", plot.log_y}, {"series", series}};
}

ordered_json to_object(const PaperReport& report) {
    ordered_json claims = ordered_json::array(), tables = ordered_json::array(), plots = ordered_json::array();
    for (const Claim& claim : report.claims) claims.push_back(to_object(claim));
    for (const Table& table : report.tables)
        tables.push_back({{"title", table.title}, {"header", table.header}, {"rows", table.rows}});
    for (const Plot& plot : report.plots) plots.push_back(to_object(plot));
    return {{"id", report.id},
            {"title", report.title},
            {"conditions", report.conditions},
            {"scenarios", report.documents},
            {"seconds", report.seconds},
            {"steal_seconds", report.steal_seconds ? ordered_json(*report.steal_seconds) : ordered_json(nullptr)},
            {"claims", claims},
            {"tables", tables},
            {"plots", plots}};
}

}  // namespace

std::string to_json(std::span<const PaperReport> reports, const Conditions& conditions) {
    ordered_json papers = ordered_json::array();
    for (const PaperReport& report : reports) papers.push_back(to_object(report));
    const ordered_json document = {{"claims_schema_version", 1},    {"quick", conditions.quick},
                                   {"machine", conditions.machine}, {"build", conditions.build},
                                   {"date", conditions.date},       {"beside", conditions.beside},
                                   {"steal", steal_line(reports)},  {"papers", papers}};
    return document.dump(1) + "\n";
}

void write_reports(const std::filesystem::path& folder, const std::string& name, std::span<const PaperReport> reports,
                   const Conditions& conditions) {
    std::vector<base::NewFile> files{{folder / (name + ".md"), to_markdown(reports, conditions)},
                                     {folder / (name + ".json"), to_json(reports, conditions)}};
    for (const PaperReport& report : reports)
        for (const Plot& plot : report.plots) files.push_back({folder / "plots" / (plot.name + ".svg"), to_svg(plot)});
    for (const PaperReport& report : reports)
        for (const Sheet& sheet : report.sheets)
            files.push_back({folder / "pictures" / (sheet.name + ".png"), sheet.png});
    base::write_files(files);
}

}  // namespace shadowbench::claims
