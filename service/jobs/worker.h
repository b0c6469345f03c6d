#pragma once

#include <string>
#include <vector>

#include "service/jobs/board.h"
#include "service/jobs/fault.h"
#include "service/jobs/folders.h"
#include "service/jobs/jobs.h"
#include "service/jobs/state_folder.h"
#include "service/privacy/hidden_folders.h"
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
    Say say;
};

// Takes the jobs from the queue, one after the other, and runs each to its end; returns once the board stops. Throws
// nothing: where the server's own storage fails, be it the store or the folders, the job keeps its place in the queue
// and that run is not counted; it is tried again, less and less often, until there is room.
void run_jobs(const Workplace& place);

}  // namespace shadowbench::service
