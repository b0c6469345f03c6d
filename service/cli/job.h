// Turns the arguments that the commands with a scenario share into the document and the options of a run.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "base/error.h"
#include "bench/run.h"
#include "service/cli/commands.h"

namespace shadowbench::service {

struct Job {
    std::shared_ptr<const nlohmann::json> document;
    bench::RunOptions options;
};

// `scenario` may also be a result.json: it stands for the scenario that it holds. Loads the libraries of techniques.
// Throws base::Error.
Job read_job(const JobArguments& arguments, const std::filesystem::path& scenario);
Job read_job(const ScenarioArguments& arguments);

// The error with the file of its scenario in front of its place.
base::Error in_file(const base::Error& error, const std::filesystem::path& file);

// The folder `given`, or, where that is empty, one in `parent` with the scenario's name.
std::filesystem::path output_folder(const std::string& given, const std::filesystem::path& parent,
                                    const nlohmann::json& document);

}  // namespace shadowbench::service
