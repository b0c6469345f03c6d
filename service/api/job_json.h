// The JSON form of a job in the API.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "service/jobs/jobs.h"

namespace shadowbench::service {

// `prefix`: see ApiRequest.
nlohmann::ordered_json to_json(const JobInfo& job, const std::vector<std::string>& artifacts,
                               const std::string& prefix);

// The JSON of a job with the names of its artifacts; a queued job has none.
nlohmann::ordered_json job_json(const Jobs& jobs, const JobInfo& job, const std::string& prefix);

// Whether the job succeeded, failed or was cancelled.
bool has_ended(const JobInfo& job);

}  // namespace shadowbench::service
