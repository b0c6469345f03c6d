#include "service/cli/outcomes.h"

#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/write_files.h"
#include "results/settled.h"
#include "service/cli/job.h"
#include "techniques/technique.h"

namespace shadowbench::service {

namespace fs = std::filesystem;

namespace {

constexpr const char* standard_folder = "results/runs";

}  // namespace

fs::path results_folder(const std::string& out, bool several, const nlohmann::json& document) {
    if (!several) return output_folder(out, standard_folder, document);
    return output_folder("", out.empty() ? standard_folder : out, document);
}

fs::path verdicts_file(const std::string& given, const std::string& out, bool several) {
    if (!given.empty() || !several) return given;
    return fs::path(out.empty() ? standard_folder : out) / "verdicts.md";
}

results::ScenarioOutcome without_result(const nlohmann::json& document, const std::string& why) {
    results::ScenarioOutcome outcome;
    outcome.result.name = document.at("name").get<std::string>();
    outcome.result.purpose = document.value("purpose", "");
    outcome.error = why;
    return outcome;
}

void report_outcomes(const std::vector<results::ScenarioOutcome>& outcomes, bool several, const fs::path& verdicts,
                     std::ostream& out) {
    std::vector<std::string> columns;
    for (const techniques::Technique& row : techniques::all()) columns.push_back(row.id);
    if (several) out << results::verdicts_text(outcomes, columns);
    if (!verdicts.empty()) {
        base::write_files({{verdicts, results::verdicts_markdown(outcomes, columns)}});
        out << fmt::format("written: {}\n", verdicts.string());
    }
    std::vector<const results::Result*> all;
    for (const results::ScenarioOutcome& outcome : outcomes) all.push_back(&outcome.result);
    out << results::unsettled_line(all);
}

}  // namespace shadowbench::service
