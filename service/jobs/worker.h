#pragma once

#include <string>
#include <vector>

#include "service/jobs/board.h"
#include "service/jobs/fault.h"
#include "service/jobs/folders.h"
#include "service/jobs/jobs.h"
#include "service/store/job_store.h"

namespace shadowbench::service {

struct Workplace {
    JobStore& store;
    JobBoard& board;
    JobFolders folders;
    std::string program;
    std::vector<std::string> data;
    JobLimits limits;
    std::vector<HiddenFolder> hidden;
};

// Takes the jobs from the queue, one after the other, and runs each to its end; returns once the board stops. Throws
// nothing: while the store cannot be written, it tries again.
void run_jobs(const Workplace& place);

// What to do about a job that ran when its server died.
void recover_running(const Workplace& place);

std::string now_utc();  // ISO 8601 with milliseconds

}  // namespace shadowbench::service
