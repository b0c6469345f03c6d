// Describes to a client why a job failed.
#pragma once

#include <vector>

#include "service/jobs/child.h"
#include "service/jobs/jobs.h"
#include "service/privacy/hidden_folders.h"

namespace shadowbench::service {

// The fault of a process that ended without a result and without a line that says why. It quotes the last lines of its
// standard error; of the paths in them the client reads what hide() leaves.
JobFault fault_of_end(const ChildReport& report, const JobLimits& limits, const std::vector<HiddenFolder>& folders);

}  // namespace shadowbench::service
