#include "service/cli/job.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "document/document.h"
#include "service/cli/libraries.h"
#include "service/cli/scenario_files.h"

namespace shadowbench::service {

namespace fs = std::filesystem;

namespace {

// A result stands for the scenario that it holds.
nlohmann::json read_document(const fs::path& file) {
    nlohmann::json document = scene::parse_json(base::read_text(file), file.string());
    if (!document.is_object() || !document.contains("scenario_hash") || !document.contains("scenario")) return document;
    nlohmann::json scenario = std::move(document["scenario"]);
    return scenario;
}

}  // namespace

Job read_job(const JobArguments& arguments, const fs::path& scenario) {
    load_libraries(arguments.libraries, arguments.memory_limit);
    Job job;
    nlohmann::json document = read_document(scenario);
    for (const std::string& assignment : arguments.set) document::set_value(document, assignment);
    job.document = std::make_shared<const nlohmann::json>(std::move(document));
    job.options.data = data_path(arguments.data, scenario);
    job.options.only = arguments.only;
    job.options.threads = arguments.threads;
    job.options.limits.all = static_cast<std::size_t>(arguments.memory_limit * 1024.0 * 1024.0 * 1024.0);
    job.options.limits.kept_rays = std::min(job.options.limits.kept_rays, job.options.limits.all / 2);
    return job;
}

Job read_job(const ScenarioArguments& arguments) {
    return read_job(arguments, find_scenario(arguments.scenario));
}

base::Error in_file(const base::Error& error, const fs::path& file) {
    const std::string name = file.string();
    if (error.where().rfind(name, 0) == 0) return error;
    return {error.code(), error.where().empty() ? name : name + ": " + error.where(), error.message()};
}

fs::path output_folder(const std::string& given, const fs::path& parent, const nlohmann::json& document) {
    if (!given.empty()) return given;
    const auto name = document.is_object() ? document.find("name") : document.end();
    const bool named = name != document.end() && name->is_string() && !name->get_ref<const std::string&>().empty();
    return parent / (named ? fs::path(name->get<std::string>()).filename() : fs::path("unnamed"));
}

}  // namespace shadowbench::service
