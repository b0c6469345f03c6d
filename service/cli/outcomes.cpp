#include "service/cli/outcomes.h"

#include <exception>
#include <ostream>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/hash_text.h"
#include "base/read_text.h"
#include "base/table.h"
#include "base/write_files.h"
#include "document/document.h"
#include "results/settled.h"
#include "service/cli/job.h"
#include "service/cli/job_pictures.h"
#include "techniques/technique.h"

namespace shadowbench::service {

namespace fs = std::filesystem;

namespace {

constexpr const char* standard_folder = "results/runs";

// Whether render has drawn this scenario, with these values, into the folder.
bool are_pictures_of(const fs::path& folder, const results::Result& result) {
    std::error_code ignored;
    if (!fs::is_regular_file(folder / "images.json", ignored)) return false;
    try {
        const nlohmann::json images = nlohmann::json::parse(base::read_text(folder / "images.json"));
        const auto document = document::expand(nlohmann::json::parse(result.document)).front().document;
        return images.at("scenario_hash") == base::hash_text(document->dump());
    } catch (const std::exception&) {  // no images.json of this program
        return false;
    }
}

// The first of the folders with pictures of this result; empty: none has.
fs::path pictures_of(const results::Result& result, const std::vector<fs::path>& folders) {
    for (const fs::path& folder : folders)
        if (are_pictures_of(folder, result)) return folder;
    return {};
}

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
                     Output& output) {
    std::ostream& out = output.text();
    std::vector<std::string> columns;
    for (const techniques::Technique& row : techniques::all()) columns.push_back(row.id);
    if (several) out << results::verdicts_text(outcomes, columns);
    if (!verdicts.empty()) {
        base::write_files({{verdicts, results::verdicts_markdown(outcomes, columns)}});
        out << fmt::format("written: {}\n", verdicts.string());
    }
    std::vector<const results::Result*> all;
    for (const results::ScenarioOutcome& outcome : outcomes) all.push_back(&outcome.result);
    out << base::wrapped(results::unsettled_line(all), output.style().width);
}

void conclude(const results::Result& result, const fs::path& folder, const PicturesSaid& said, Output& output) {
    output.explain(result);
    output.text() << fmt::format("written: {0}/result.json, {0}/result.csv\n", folder.string());
    const fs::path found = pictures_of(result, {pictures_folder(folder), fs::path("results/images") / result.name});
    if (!said.fault.empty())
        output.text() << fmt::format("pictures: none: {}\n", said.fault);
    else if (!found.empty())
        output.text() << fmt::format("pictures: {}\n", found.string());
    else if (!said.command.empty())
        output.text() << fmt::format("pictures: none yet; this draws them: {}\n", said.command);
    output.text() << std::flush;
}

}  // namespace shadowbench::service
