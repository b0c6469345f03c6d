// A job as the API shows it.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "service/jobs/jobs.h"

namespace shadowbench::service {

nlohmann::ordered_json to_json(const JobInfo& job, const std::vector<std::string>& artifacts);

// With the names of its artifacts, once there may be any.
nlohmann::ordered_json job_json(const Jobs& jobs, const JobInfo& job);

bool has_ended(const JobInfo& job);

}  // namespace shadowbench::service
