// What the commands that take a scenario share: arguments -> document and options.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "bench/run.h"
#include "service/cli/commands.h"

namespace shadowbench::service {

struct Job {
    std::shared_ptr<const nlohmann::json> document;
    bench::RunOptions options;
};

// `scenario` may be a result.json too: the scenario it holds is run again. Throws base::Error.
Job read_job(const JobArguments& arguments, const std::filesystem::path& scenario);
Job read_job(const ScenarioArguments& arguments);

// As told, or in `otherwise` by the scenario's name.
std::filesystem::path output_folder(const std::string& told, const std::filesystem::path& otherwise,
                                    const nlohmann::json& document);

}  // namespace shadowbench::service
