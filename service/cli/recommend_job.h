// A job that finds a recommendation instead of running its scenario.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/progress.h"
#include "bench/run.h"
#include "service/privacy/hidden_folders.h"

namespace shadowbench::service {

// Progress, and the fraction of the job that is done.
using JobProgressCallback = std::function<void(const bench::Progress& progress, double fraction)>;

// Explores the scenario as `request`, a recommend::Request, asks. Writes result.json, with the request under
// /recommendation/request, result.csv and table.txt, the answer's text, into `folder`. The stages are "reference",
// "exploring" and "confirming"; the last two count the seconds of the budget. Returns whether a setting reaches the
// error. Throws what recommend::explore throws, and Error{bad_input} for a wrong request.
bool recommend_job(const nlohmann::json& document, const nlohmann::json& request, const bench::RunOptions& options,
                   const std::filesystem::path& folder, const std::vector<HiddenFolder>& hidden,
                   const JobProgressCallback& report);

}  // namespace shadowbench::service
